// Opens a page in headless Chromium, takes its pictures at three widths and for paper, and says what is wrong with it.
//
// node look.mjs FOLDER_OF_PACKAGES PAGE OUT: prints one JSON document. Exit status 77 where no browser can be started.
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { resolve } from 'node:path';

const [packages, page, out] = process.argv.slice(2);
const WIDTHS = [390, 768, 1280];
let browser = null;

// the browser goes however this ends
function end(status) {
  if (browser && browser.process()) browser.process().kill('SIGKILL');
  process.exit(status);
}
function within(promise, seconds, what) {
  const late = new Promise((_, refuse) => setTimeout(() => refuse(new Error(`${what}: nothing within ${seconds} s`)), 1000 * seconds));
  return Promise.race([promise, late]);
}

async function start() {
  const require = createRequire(pathToFileURL(resolve(packages, 'package.json')));
  const load = async (name) => (await import(pathToFileURL(require.resolve(name)).href)).default;
  const puppeteer = await load('puppeteer-core');
  const env = { ...process.env, LANG: 'C', LC_ALL: 'C', LANGUAGE: '' };
  const own = process.env.MAVID_CHROMIUM;
  if (own) return puppeteer.launch({ executablePath: own, headless: 'shell', args: ['--no-sandbox'], env });
  const chromium = await load('@sparticuz/chromium');
  return puppeteer.launch({ executablePath: await chromium.executablePath(), headless: 'shell', args: chromium.args, env });
}

// runs inside of the page before its own script: what is drawn into a picture that turns, its axes and its words
function listen() {
  const pens = CanvasRenderingContext2D.prototype;
  const heard = (pen) => (pen.canvas.heard = pen.canvas.heard || { axes: [], words: [], way: [], at: null });
  const hear = (name, tell) => {
    const own = pens[name];
    pens[name] = function (...given) {
      tell(this, given);
      return own.apply(this, given);
    };
  };
  hear('scale', (pen) => { pen.canvas.heard = null; });
  hear('beginPath', (pen) => { heard(pen).way = []; });
  hear('moveTo', (pen, [x, y]) => { heard(pen).at = [x, y]; });
  hear('lineTo', (pen, [x, y]) => {
    const of = heard(pen);
    if (of.at) of.way.push([of.at, [x, y]]);
    of.at = [x, y];
  });
  // the axes alone are half transparent
  hear('stroke', (pen) => { if (pen.globalAlpha === 0.5) heard(pen).axes.push(...heard(pen).way); });
  hear('fillText', (pen, [text, x, y]) => { heard(pen).words.push([text, { left: x, right: x + pen.measureText(text).width, top: y - 9, bottom: y + 2 }]); });
}

// runs inside of the page
function wrong() {
  const found = [];
  const wide = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > wide + 1) found.push(`the page is ${document.documentElement.scrollWidth} wide`);
  const scrolls = (element) => {
    for (let at = element; at; at = at.parentElement) if (/auto|scroll/.test(getComputedStyle(at).overflowX)) return true;
    return false;
  };
  const words = (element) => (element.textContent || '').trim().slice(0, 40);
  for (const element of document.querySelectorAll('h1,h2,h3,p,td,th,li,figcaption,summary,button,canvas,svg,a,span')) {
    const box = element.getBoundingClientRect();
    if (box.width === 0 || scrolls(element)) continue;
    if (box.right > wide + 1 || box.left < -1) found.push(`${element.tagName} outside of the page: ${words(element)}`);
    if (getComputedStyle(element).overflowX === 'hidden' && element.scrollWidth > element.clientWidth + 1) found.push(`cut: ${words(element)}`);
  }
  // a part of the line from one place to another that is inside of a box
  const runs = ([[x, y], [to_x, to_y]], box) => {
    let from = 0, to = 1;
    for (const [start, end, low, high] of [[x, to_x, box.left, box.right], [y, to_y, box.top, box.bottom]]) {
      if (Math.abs(end - start) < 1e-9) {
        if (start < low || start > high) return false;
        continue;
      }
      const one = (low - start) / (end - start), other = (high - start) / (end - start);
      from = Math.max(from, Math.min(one, other));
      to = Math.min(to, Math.max(one, other));
    }
    return from < to;
  };
  for (const canvas of document.querySelectorAll('.path3 canvas')) {
    if (canvas.clientWidth === 0) continue;
    const { axes, words: written } = canvas.heard || { axes: [], words: [] };
    if (axes.length < 3) found.push('a path without axes');
    written.forEach(([text, box], index) => {
      for (const [other, of] of written.slice(index + 1)) {
        const across = Math.min(box.right, of.right) - Math.max(box.left, of.left), down = Math.min(box.bottom, of.bottom) - Math.max(box.top, of.top);
        if (across > 0 && down > 0) found.push(`over each other in a path: ${text} | ${other}`);
      }
    });
    for (const [text, box] of written) if (axes.some((axis) => runs(axis, box))) found.push(`struck through by an axis: ${text}`);
  }
  for (const svg of document.querySelectorAll('svg')) {
    const edge = svg.getBoundingClientRect();
    if (edge.width === 0) continue;
    const texts = [...svg.querySelectorAll('text')].map((text) => [text, text.getBoundingClientRect()]);
    for (const [text, box] of texts) {
      if (box.left < edge.left - 1 || box.right > edge.right + 1 || box.bottom > edge.bottom + 1) found.push(`cut in a drawing: ${words(text)}`);
    }
    const straight = [...svg.querySelectorAll('path')].map((path) => path.getBoundingClientRect()).filter((box) => box.width < 3 || box.height < 3);
    for (const [text, box] of texts) {
      const inside = { left: box.left + 1, right: box.right - 1, top: box.top + 3, bottom: box.bottom - 3 };
      if (straight.some((line) => runs([[line.left, line.top], [line.right, line.bottom]], inside))) found.push(`struck through by a line: ${words(text)}`);
    }
    texts.forEach(([text, a], index) => {
      for (const [other, b] of texts.slice(index + 1)) {
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left), down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (across > 2 && down > 4) found.push(`over each other: ${words(text)} | ${words(other)}`);
      }
    });
  }
  return found;
}

setTimeout(() => { console.error('no end within 300 s'); end(77); }, 300000);
try {
  browser = await within(start(), 60, 'the browser');
} catch (error) {
  console.error(String(error.message).split('\n')[0]);
  end(77);
}
try {
  const said = [], requests = [], seen = {};
  const tab = await within(browser.newPage(), 30, 'a tab');
  tab.on('console', (message) => said.push(message.text()));
  tab.on('pageerror', (error) => said.push(String(error.message)));
  tab.on('request', (request) => requests.push(request.url()));
  await tab.evaluateOnNewDocument(listen);
  await tab.setViewport({ width: WIDTHS[0], height: 844, deviceScaleFactor: 1 });
  await within(tab.goto(pathToFileURL(resolve(page)).href, { waitUntil: 'load' }), 60, 'the page');
  const settled = () => tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
  const at = async (width) => {
    await tab.setViewport({ width, height: 844, deviceScaleFactor: 1 });
    await within(settled(), 30, `the page at ${width}`);
  };
  // a computer with much else to do may be late with a picture; what is wrong with the page is told without it
  const late = [];
  const look = async (width, name, has_picture = true) => {
    await at(width);
    seen[name] = await within(tab.evaluate(wrong), 30, `the page at ${width}`);
    if (!has_picture) return;
    try {
      await within(tab.screenshot({ path: resolve(out, `${name}.png`), fullPage: true }), 60, name);
    } catch (error) {
      late.push(name);
    }
  };
  for (const width of WIDTHS) await look(width, String(width));
  const plots = await tab.evaluate(() => document.querySelectorAll('.uplot canvas').length);
  const turns = await tab.evaluate(() => document.querySelectorAll('.path3 canvas').length);
  // one cursor: a place on the path is the time in the plots
  const cursor = await tab.evaluate(() => {
    const canvas = document.querySelector('.path3 canvas');
    if (!canvas) return null;
    canvas.scrollIntoView();
    const box = canvas.getBoundingClientRect(), at = { clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, pointerId: 1, bubbles: true };
    canvas.setPointerCapture = () => {};
    canvas.dispatchEvent(new PointerEvent('pointerdown', at));
    canvas.dispatchEvent(new PointerEvent('pointerup', at));
    return document.querySelector('.path3 .note[aria-live]').textContent;
  });
  await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
  await look(WIDTHS[0], 'dark-390');
  await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'light' }]);
  await tab.evaluate(() => document.querySelectorAll('details').forEach((fold) => { fold.open = true; }));
  await look(WIDTHS[0], 'open-390', false);
  await tab.evaluate(() => document.querySelectorAll('details').forEach((fold) => { fold.open = false; }));
  await tab.emulateMediaType('print');
  await look(718, 'print');
  let pages = null;
  try {
    const pdf = await within(tab.pdf({ format: 'A4', margin: { top: '12mm', bottom: '12mm', left: '12mm', right: '12mm' } }), 60, 'the paper');
    writeFileSync(resolve(out, 'print.pdf'), pdf);
    pages = (Buffer.from(pdf).toString('latin1').match(/\/Type\s*\/Page\b/g) || []).length;
  } catch (error) {
    console.error(String(error.message));
  }
  console.log(JSON.stringify({ console: said, requests, seen, plots, turns, cursor, pages, late, bytes: readFileSync(page).length }));
  end(0);
} catch (error) {
  console.error(error.message);
  end(1);
}
