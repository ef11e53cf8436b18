//! Line charts as SVG, self-contained, no scripts.

use std::fmt::Write;

/// One line of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// for the legend
    pub label: String,
    /// abscissa
    pub x: Vec<f64>,
    /// ordinate; what is not finite is left out
    pub y: Vec<f64>,
}

/// One set of axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// over the axes
    pub title: String,
    /// with its unit
    pub x_label: String,
    /// with its unit
    pub y_label: String,
    /// drawn in order
    pub lines: Vec<Line>,
}

/// Colours that stay apart for most eyes (Okabe and Ito 2008).
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 230.0;
const MARGIN: (f64, f64, f64, f64) = (74.0, 130.0, 26.0, 40.0); // left, right, top, bottom

/// Panels one under the other as one SVG document.
#[must_use]
pub fn svg(panels: &[Panel]) -> String {
    let total = HEIGHT * panels.len() as f64;
    let mut out = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {total}" font-family="sans-serif" font-size="11"><rect width="{WIDTH}" height="{total}" fill="#fff"/>"##
    );
    for (index, panel) in panels.iter().enumerate() {
        let _ = write!(out, r#"<g transform="translate(0 {})">"#, HEIGHT * index as f64);
        draw(&mut out, panel);
        out.push_str("</g>");
    }
    out.push_str("</svg>\n");
    out
}

fn draw(out: &mut String, panel: &Panel) {
    let (left, right, top, bottom) = MARGIN;
    let (wide, high) = (WIDTH - left - right, HEIGHT - top - bottom);
    let x_range = range(panel.lines.iter().flat_map(|line| line.x.iter()), 0.0);
    let y_range = range(panel.lines.iter().flat_map(|line| line.y.iter()), 0.05);
    let x_at = |x: f64| left + wide * (x - x_range.0) / (x_range.1 - x_range.0);
    let y_at = |y: f64| top + high * (1.0 - (y - y_range.0) / (y_range.1 - y_range.0));
    let _ = write!(
        out,
        r#"<text x="{left}" y="16" font-weight="bold">{}</text><text x="{}" y="{}" text-anchor="middle">{}</text><text transform="translate(14 {}) rotate(-90)" text-anchor="middle">{}</text>"#,
        escape(&panel.title),
        left + wide / 2.0,
        HEIGHT - 6.0,
        escape(&panel.x_label),
        top + high / 2.0,
        escape(&panel.y_label)
    );
    for (value, text) in ticks(x_range) {
        let x = x_at(value);
        let _ = write!(
            out,
            r##"<path d="M{x:.1} {top}V{}" stroke="#e4e4e4"/><text x="{x:.1}" y="{}" text-anchor="middle">{text}</text>"##,
            top + high,
            top + high + 14.0
        );
    }
    for (value, text) in ticks(y_range) {
        let y = y_at(value);
        let _ = write!(
            out,
            r##"<path d="M{left} {y:.1}H{}" stroke="#e4e4e4"/><text x="{}" y="{:.1}" text-anchor="end">{text}</text>"##,
            left + wide,
            left - 5.0,
            y + 4.0
        );
    }
    let _ = write!(
        out,
        r##"<rect x="{left}" y="{top}" width="{wide}" height="{high}" fill="none" stroke="#555"/>"##
    );
    let mut legend_y = top + 10.0;
    for (line, colour) in panel.lines.iter().zip(COLOURS.iter().cycle()) {
        let mut path = String::new();
        for (x, y) in line.x.iter().zip(&line.y).filter(|(x, y)| x.is_finite() && y.is_finite()) {
            let command = if path.is_empty() { 'M' } else { 'L' };
            let _ = write!(path, "{command}{:.1} {:.1}", x_at(*x), y_at(*y));
        }
        let x = left + wide + 8.0;
        let _ = write!(
            out,
            r#"<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.4"/><path d="M{x} {legend_y}h16" stroke="{colour}" stroke-width="2"/><text x="{}" y="{}">{}</text>"#,
            x + 20.0,
            legend_y + 4.0,
            escape(&line.label)
        );
        legend_y += 16.0;
    }
}

fn range<'a>(values: impl Iterator<Item = &'a f64>, spare: f64) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
    if low > high {
        return (0.0, 1.0);
    }
    let pad = if high > low { (high - low) * spare } else { low.abs().max(1e-9) * 0.1 };
    (low - pad, high + pad)
}

/// Round values (1, 2 or 5 times a power of ten), four to nine of them, with their texts.
fn ticks((low, high): (f64, f64)) -> Vec<(f64, String)> {
    let rough = (high - low) / 5.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(rough);
    let mut out = Vec::new();
    let mut value = (low / step).ceil() * step;
    while value <= high && out.len() < 12 {
        let clean = if value.abs() < step * 1e-6 { 0.0 } else { value };
        let text = if clean != 0.0 && (clean.abs() < 1e-3 || clean.abs() >= 1e5) {
            format!("{clean:.1e}")
        } else {
            let text = format!("{clean:.5}");
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        };
        out.push((clean, text));
        value += step;
    }
    out
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        let texts: Vec<String> = ticks((0.0, 1.0)).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
    }

    #[test]
    fn a_chart_is_whole_and_escapes_its_words() {
        let line = Line { label: "a<b".into(), x: vec![0.0, 1.0, 2.0], y: vec![1.0, f64::NAN, 3.0] };
        let text = svg(&[Panel { title: "t".into(), lines: vec![line], ..Panel::default() }]);
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
        assert!(text.contains("a&lt;b") && !text.contains("NaN"));
    }
}
