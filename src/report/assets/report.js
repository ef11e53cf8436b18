// Makes the drawings of the page into plots to zoom and to read values from. Without it, and on paper, the drawings stay.
(function () {
  'use strict';
  var HUES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9'];
  var DARK = ['#56b4e9', '#ff8a3d', '#2fc99b', '#e5a3c6', '#f0bd3c', '#8fd0f5'];
  var SPAN = 'rgba(230,159,0,0.22)';
  var night = window.matchMedia('(prefers-color-scheme: dark)');
  var groups = {};
  var seconds = {};

  function ink() { return getComputedStyle(document.body).color; }
  function hue(index) { return index >= HUES.length ? ink() : (night.matches ? DARK : HUES)[index]; }
  // a colour of the page's words is rgb(...), the others are of six digits
  function faint(colour) { return colour[0] === '#' ? colour + '33' : colour.replace('rgb(', 'rgba(').replace(')', ', 0.2)'); }
  function rough(value) { return value == null ? '–' : String(+value.toPrecision(4)); }
  function read(box) { return JSON.parse(box.querySelector('script').textContent); }

  // a tick's value, short enough for its place
  function tick(value) {
    if (value == null) return '';
    var size = Math.abs(value);
    return size !== 0 && (size >= 1e5 || size < 1e-4) ? value.toExponential().replace('e+', 'e') : String(+value.toPrecision(8));
  }

  // the tables of a panel's lines and bands on one abscissa
  function joined(of) {
    var tables = [], last = null;
    of.lines.forEach(function (line) {
      last = line.x || last;
      tables.push([last, line.y]);
    });
    of.bands.forEach(function (band) { tables.push([band.x, band.low, band.high]); });
    return uPlot.join(tables);
  }

  function shading(of) {
    return function (u) {
      u.ctx.save();
      u.ctx.fillStyle = SPAN;
      of.spans.forEach(function (span) {
        var from = Math.max(u.valToPos(span[0], 'x', true), u.bbox.left);
        var to = Math.min(u.valToPos(span[1], 'x', true), u.bbox.left + u.bbox.width);
        if (to > from) u.ctx.fillRect(from, u.bbox.top, to - from, u.bbox.height);
      });
      u.ctx.restore();
    };
  }

  function series(of) {
    var all = [{ label: of.x_label, value: function (u, v) { return rough(v); } }];
    of.lines.forEach(function (line) {
      var one = {
        label: line.label || of.y_label, stroke: hue(line.colour), width: 1.6, spanGaps: true,
        value: function (u, v) { return rough(v); }, points: { show: false }
      };
      if (line.stroke === 'dashed') one.dash = [6, 4];
      if (line.stroke === 'dots') { one.paths = function () { return null; }; one.points = { show: true, size: 7, fill: one.stroke }; one.class = 'dots'; }
      if (line.stroke === 'stems') one.paths = uPlot.paths.bars({ size: [0.4, 3] });
      all.push(one);
    });
    of.bands.forEach(function () {
      [0, 1].forEach(function () { all.push({ label: '', width: 0, points: { show: false }, spanGaps: true, class: 'hidden' }); });
    });
    return all;
  }

  function options(of, box) {
    var first = 1 + of.lines.length;
    var axis = { stroke: ink, grid: { stroke: 'rgba(128,128,128,0.2)', width: 1 }, ticks: { stroke: 'rgba(128,128,128,0.4)', width: 1 }, font: '12px system-ui, sans-serif', labelFont: '12px system-ui, sans-serif' };
    var narrow = box.clientWidth < 500;
    var ticks = function (u, values) { return values.map(tick); };
    // bars are whole at the ends too
    var room = of.lines.some(function (line) { return line.stroke === 'stems'; }) ? 0.03 : 0;
    var wide = function (u, low, high) { var more = room * (high - low); return [low - more, high + more]; };
    var key = of.cursor == null ? null : 'time' + of.cursor;
    return {
      title: '', width: box.clientWidth, height: narrow ? 220 : 250,
      scales: { x: Object.assign({ time: false, distr: of.log[0] ? 3 : 1 }, room ? { range: wide } : {}), y: { distr: of.log[1] ? 3 : 1 } },
      axes: [
        Object.assign({ label: of.x_label, labelSize: 18, size: 34, values: ticks }, axis),
        Object.assign({ label: of.y_label, labelSize: 18, size: narrow ? 46 : 56, values: ticks }, axis)
      ],
      series: series(of),
      // a mark is a line or a dot as it is drawn
      legend: { markers: {
        dash: function (u, index) { return (of.lines[index - 1] || {}).stroke === 'dashed' ? 'dashed' : 'solid'; },
        fill: function (u, index) { var line = of.lines[index - 1]; return line && line.stroke === 'dots' ? hue(line.colour) : 'transparent'; }
      } },
      bands: of.bands.map(function (band, place) {
        return { series: [first + 2 * place + 1, first + 2 * place], fill: faint(hue(band.colour)), dir: -1 };
      }),
      cursor: Object.assign({ drag: { x: true, y: false } }, key ? { sync: { key: key } } : {}),
      hooks: {
        drawClear: [shading(of)],
        setCursor: key ? [function (u) { moved(of.cursor, u); }] : []
      }
    };
  }

  // the other pictures of the same flight follow a plot's cursor
  function moved(group, u) {
    if (u.cursor.left == null || u.cursor.left < 0) return;
    var time = u.posToVal(u.cursor.left, 'x');
    (seconds[group] || []).forEach(function (hear) { hear(time); });
  }

  function show(group, time) {
    (groups[group] || []).forEach(function (u) {
      u.setCursor({ left: u.valToPos(time, 'x'), top: u.over.clientHeight / 2 }, false);
    });
    (seconds[group] || []).forEach(function (hear) { hear(time); });
  }

  function keys(u) {
    u.root.tabIndex = 0;
    u.root.setAttribute('role', 'group');
    u.root.addEventListener('keydown', function (event) {
      var step = { ArrowLeft: -1, ArrowRight: 1 }[event.key], zoom = { '+': 0.5, '-': 2 }[event.key];
      if (event.key === 'Escape' || event.key === '0') u.setScale('x', { min: u.data[0][0], max: u.data[0][u.data[0].length - 1] });
      else if (step) u.setCursor({ left: Math.min(Math.max((u.cursor.left || 0) + 8 * step, 0), u.over.clientWidth), top: 10 });
      else if (zoom) {
        var middle = u.posToVal(Math.max(u.cursor.left, 0) || u.over.clientWidth / 2, 'x');
        u.setScale('x', { min: middle - (middle - u.scales.x.min) * zoom, max: middle + (u.scales.x.max - middle) * zoom });
      } else return;
      event.preventDefault();
    });
  }

  function plot(box) {
    var of = read(box), place = document.createElement('div'), u = null;
    place.className = 'live';
    box.insertBefore(place, box.firstChild);
    box.classList.add('has-live');
    var heading = document.createElement('p');
    heading.className = 'plot-title';
    heading.textContent = of.title;
    function make() {
      if (u) {
        u.destroy();
        groups[of.cursor] = (groups[of.cursor] || []).filter(function (other) { return other !== u; });
      }
      place.textContent = '';
      place.appendChild(heading);
      u = new uPlot(options(of, box), joined(of), place);
      u.root.setAttribute('aria-label', of.title + '. Arrow keys move the cursor, plus and minus zoom, Escape shows all.');
      keys(u);
      if (of.cursor != null) (groups[of.cursor] = groups[of.cursor] || []).push(u);
    }
    make();
    night.addEventListener('change', make);
    return function () { if (box.clientWidth && Math.abs(box.clientWidth - u.width) > 1) make(); };
  }

  function colourOf(ramp, value, along) {
    return ramp[value.begins.filter(function (begin) { return along >= begin; }).length];
  }

  // whether a line from a to b runs through a rectangle
  function crosses(a, b, left, top, right, bottom) {
    var from = 0, to = 1;
    [[a[0], b[0], left, right], [a[1], b[1], top, bottom]].forEach(function (of) {
      var way = of[1] - of[0];
      if (Math.abs(way) < 1e-9) {
        if (of[0] < of[2] || of[0] > of[3]) to = -1;
        return;
      }
      var one = (of[2] - of[0]) / way, other = (of[3] - of[0]) / way;
      from = Math.max(from, Math.min(one, other));
      to = Math.min(to, Math.max(one, other));
    });
    return from <= to;
  }
  // so far a word may be from the place it is meant for, the nearest first, dots
  var STEPS = [0];
  for (var step = 5; step <= 75; step += 5) STEPS.push(step, -step);

  function path(box) {
    var of = read(box), canvas = document.createElement('canvas'), place = document.createElement('div');
    var said = document.createElement('p'), turned = 0.7, tilted = 0.5, marked = null, chosen = 0, zoom = 1, held = null, flat = [];
    place.className = 'live';
    said.className = 'note';
    said.setAttribute('aria-live', 'polite');
    box.insertBefore(place, box.firstChild);
    box.classList.add('has-live');
    var heading = document.createElement('p');
    heading.className = 'plot-title';
    heading.textContent = of.title;
    place.appendChild(heading);
    var choice = document.createElement('p');
    of.values.forEach(function (value, index) {
      var button = document.createElement('button');
      button.type = 'button';
      button.textContent = value.name;
      button.setAttribute('aria-pressed', String(index === 0));
      button.addEventListener('click', function () {
        chosen = index;
        Array.prototype.forEach.call(choice.children, function (other, at) { other.setAttribute('aria-pressed', String(at === index)); });
        explain();
        draw();
      });
      choice.appendChild(button);
    });
    place.appendChild(choice);
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', of.title + '. Arrow keys turn it, plus and minus zoom; click on a place to see the time.');
    place.appendChild(canvas);
    var legend = document.createElement('p');
    legend.className = 'note legend3';
    // each value has colours of its own
    function explain() {
      legend.textContent = '';
      of.values[chosen].classes.forEach(function (words, index) {
        var part = document.createElement('span'), mark = document.createElement('i');
        mark.style.background = of.ramp[index];
        part.appendChild(mark);
        part.appendChild(document.createTextNode(words));
        legend.appendChild(part);
      });
      legend.appendChild(document.createTextNode(of.unit + '; ' + of.values[chosen].words));
    }
    explain();
    place.appendChild(legend);
    place.appendChild(said);

    function seen(at) {
      var right = -at[1] * Math.cos(turned) + at[0] * Math.sin(turned);
      var depth = at[0] * Math.cos(turned) + at[1] * Math.sin(turned);
      return [right, -at[2] * Math.cos(tilted) - depth * Math.sin(tilted)];
    }
    var low = [0, 1, 2].map(function (k) { return Math.min.apply(null, of.position_m.map(function (at) { return at[k]; })); });
    var high = [0, 1, 2].map(function (k) { return Math.max.apply(null, of.position_m.map(function (at) { return at[k]; })); });
  
    function draw() {
      var wide = Math.max(100, place.clientWidth), tall = Math.min(380, Math.max(240, wide * 0.6)), dots = window.devicePixelRatio || 1;
      canvas.width = wide * dots;
      canvas.height = tall * dots;
      canvas.style.height = tall + 'px';
      var pen = canvas.getContext('2d'), least = [Infinity, Infinity], most = [-Infinity, -Infinity];
      of.position_m.concat([low, [high[0], low[1], low[2]], [low[0], high[1], low[2]]]).forEach(function (at) {
        seen(at).forEach(function (value, k) {
          least[k] = Math.min(least[k], value);
          most[k] = Math.max(most[k], value);
        });
      });
      var scale = zoom * Math.min((wide - 60) / Math.max(most[0] - least[0], 0.1), (tall - 60) / Math.max(most[1] - least[1], 0.1));
      pen.scale(dots, dots);
      function put(at) {
        var xy = seen(at);
        return [wide / 2 + scale * (xy[0] - (least[0] + most[0]) / 2), tall / 2 + scale * (xy[1] - (least[1] + most[1]) / 2)];
      }
      pen.font = '12px system-ui, sans-serif';
      pen.strokeStyle = ink();
      pen.globalAlpha = 0.5;
      var ends = [0, 1, 2].map(function (k) {
        var end = low.slice();
        end[k] = high[k];
        var a = put(low), b = put(end);
        pen.beginPath();
        pen.moveTo(a[0], a[1]);
        pen.lineTo(b[0], b[1]);
        pen.stroke();
        return [a, b];
      });
      pen.globalAlpha = 1;
      pen.lineWidth = 2.4;
      pen.lineCap = 'round';
      flat = of.position_m.map(put);
      for (var i = 0; i + 1 < flat.length; i++) {
        pen.strokeStyle = colourOf(of.ramp, of.values[chosen], of.values[chosen].along[i]);
        pen.beginPath();
        pen.moveTo(flat[i][0], flat[i][1]);
        pen.lineTo(flat[i + 1][0], flat[i + 1][1]);
        pen.stroke();
      }
      // words last, beside the axes and on a halo of the page's colour: no line runs through them
      var written = [], flown = flat.slice(1).map(function (to, i) { return [flat[i], to]; });
      function isClear(lines, x, y, long) {
        return lines.every(function (line) { return !crosses(line[0], line[1], x - 3, y - 13, x + long + 3, y + 5); });
      }
      function isFree(x, y, long) {
        return y >= 12 && y <= tall - 4 && isClear(ends, x, y, long) && written.every(function (other) {
          return Math.abs(y - other[1]) >= 15 || x + long + 6 <= other[0] || other[0] + other[2] + 6 <= x;
        });
      }
      ends.forEach(function (axis, k) {
        var a = axis[0], b = axis[1], words = of.axes[k] + ' ' + (+(high[k] - low[k]).toPrecision(2)) + ' m';
        var long = pen.measureText(words).width, x = k === 2 ? a[0] - long / 2 : b[0] + (b[0] < a[0] ? -long / 2 : 4), y = k === 2 ? a[1] + 14 : b[1] + 14;
        x = Math.min(Math.max(x, 4), wide - long - 4);
        y = Math.min(Math.max(y, 12), tall - 4);
        // at an end there may be an axis or the path, and of a flight that is long in one direction only the ends lie together
        var spots = [];
        [0, long + 10, -long - 10].forEach(function (aside) {
          var at = Math.min(Math.max(x + aside, 4), wide - long - 4);
          STEPS.forEach(function (far) { if (isFree(at, y + far, long)) spots.push([at, y + far]); });
        });
        var clear = spots.filter(function (spot) { return isClear(flown, spot[0], spot[1], long); });
        var spot = clear[0] || spots[0] || [x, y];
        x = spot[0];
        y = spot[1];
        written.push([x, y, long]);
        pen.lineWidth = 4;
        pen.lineJoin = 'round';
        pen.strokeStyle = getComputedStyle(document.body).backgroundColor;
        pen.strokeText(words, x, y);
        pen.fillStyle = ink();
        pen.fillText(words, x, y);
      });
      pen.lineWidth = 2.4;
      if (marked != null) {
        pen.strokeStyle = ink();
        pen.beginPath();
        pen.arc(flat[marked][0], flat[marked][1], 7, 0, 2 * Math.PI);
        pen.stroke();
      }
    }
    function tell() {
      said.textContent = marked == null ? 'Drag to turn, click on a place to see its time in all plots.' :
        'At ' + rough(of.time_s[marked]) + ' s: ' + of.axes.map(function (name, k) { return name + ' ' + rough(of.position_m[marked][k]) + ' m'; }).join(', ') +
        '; ' + of.values.map(function (value) { return value.name + ' ' + rough(value.along[marked]); }).join(', ') + ' ' + of.unit + '.';
    }
    function nearest(wanted, distance) {
      var best = null, least = Infinity;
      wanted.forEach(function (one, index) {
        var far = distance(one);
        if (far < least) { least = far; best = index; }
      });
      return best;
    }
    (seconds[of.cursor] = seconds[of.cursor] || []).push(function (time) {
      marked = nearest(of.time_s, function (at) { return Math.abs(at - time); });
      draw();
      tell();
    });
    canvas.addEventListener('pointerdown', function (event) {
      held = { x: event.clientX, y: event.clientY, far: 0 };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', function (event) {
      if (!held) return;
      turned += (event.clientX - held.x) * 0.01;
      tilted = Math.min(1.57, Math.max(0, tilted + (event.clientY - held.y) * 0.01));
      held = { x: event.clientX, y: event.clientY, far: held.far + Math.abs(event.clientX - held.x) + Math.abs(event.clientY - held.y) };
      draw();
    });
    canvas.addEventListener('pointerup', function (event) {
      var was = held, edge = canvas.getBoundingClientRect();
      held = null;
      if (!was || was.far > 4) return;
      var x = event.clientX - edge.left, y = event.clientY - edge.top;
      var index = nearest(flat, function (at) { return Math.hypot(at[0] - x, at[1] - y); });
      if (index != null) show(of.cursor, of.time_s[index]);
    });
    canvas.addEventListener('keydown', function (event) {
      if (event.key === 'ArrowLeft') turned -= 0.1;
      else if (event.key === 'ArrowRight') turned += 0.1;
      else if (event.key === 'ArrowUp') tilted = Math.min(1.57, tilted + 0.1);
      else if (event.key === 'ArrowDown') tilted = Math.max(0, tilted - 0.1);
      else if (event.key === '+') zoom *= 1.25;
      else if (event.key === '-') zoom /= 1.25;
      else return;
      event.preventDefault();
      draw();
    });
    tell();
    draw();
    night.addEventListener('change', draw);
    return draw;
  }

  function live(box, make) {
    var again = make(box);
    if (window.ResizeObserver) new ResizeObserver(function () { window.requestAnimationFrame(again); }).observe(box);
  }
  // what is folded has no width yet
  function start(root) {
    root.querySelectorAll('.plot:not(.has-live), .path3:not(.has-live)').forEach(function (box) {
      if (box.clientWidth > 0) live(box, box.classList.contains('plot') ? plot : path);
    });
  }
  document.body.classList.add('live-page');
  start(document);
  document.querySelectorAll('details').forEach(function (fold) {
    fold.addEventListener('toggle', function () { if (fold.open) start(fold); });
  });
})();
