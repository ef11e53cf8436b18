//! A panel: axes, shading, bands, lines, legend.

use super::axis::Axis;
use super::colour::colour;
use super::frame::WIDTH;
use super::panel::{Band, Line, Panel, Stroke};
use crate::text::markup;
use std::fmt::Write;

/// Dots.
pub(super) const HEIGHT: f64 = 230.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 130.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 40.0;
/// Letters of a legend's line.
const LEGEND_LETTERS: usize = 17;

/// Places on the sheet.
struct Sheet {
    x: Axis,
    y: Axis,
}

impl Sheet {
    const WIDE: f64 = WIDTH - LEFT - RIGHT;
    const HIGH: f64 = HEIGHT - TOP - BOTTOM;

    fn at(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((self.x_at(x)?, TOP + Self::HIGH * (1.0 - self.y.share(y)?)))
    }

    fn x_at(&self, x: f64) -> Option<f64> {
        self.x.share(x).map(|share| LEFT + Self::WIDE * share)
    }
}

pub(super) fn panel(out: &mut String, panel: &Panel) {
    let xs = panel.lines.iter().flat_map(|line| &line.x).chain(panel.bands.iter().flat_map(|band| &band.x));
    let ys = panel.lines.iter().flat_map(|line| &line.y);
    let ys = ys.chain(panel.bands.iter().flat_map(|band| band.low.iter().chain(&band.high)));
    let sheet = Sheet {
        x: Axis::covering(xs.copied(), 0.0, panel.log.0),
        y: Axis::covering(ys.copied(), 0.05, panel.log.1),
    };
    words(out, panel);
    for [from, to] in &panel.spans {
        if let (Some(from), Some(to)) = (sheet.x_at(*from), sheet.x_at(*to)) {
            let (from, to) = (from.max(LEFT), to.min(LEFT + Sheet::WIDE));
            let _ = write!(
                out,
                r##"<rect class="span" x="{from:.1}" y="{TOP}" width="{:.1}" height="{}" fill="#e69f00" fill-opacity="0.22"/>"##,
                (to - from).max(1.0),
                Sheet::HIGH
            );
        }
    }
    grid(out, &sheet);
    panel.bands.iter().for_each(|band| draw_band(out, &sheet, band));
    for (index, line) in panel.lines.iter().enumerate() {
        draw_line(out, &sheet, line, colour(line.colour.unwrap_or(index)));
    }
    legend(out, panel);
}

fn words(out: &mut String, panel: &Panel) {
    let _ = write!(
        out,
        r#"<text x="{LEFT}" y="16" font-weight="bold">{}</text><text x="{}" y="{}" text-anchor="middle">{}</text><text transform="translate(14 {}) rotate(-90)" text-anchor="middle">{}</text>"#,
        markup(&panel.title),
        LEFT + Sheet::WIDE / 2.0,
        HEIGHT - 6.0,
        markup(&panel.x_label),
        TOP + Sheet::HIGH / 2.0,
        markup(&panel.y_label)
    );
}

fn grid(out: &mut String, sheet: &Sheet) {
    for (value, text) in sheet.x.ticks() {
        let Some(x) = sheet.x_at(value) else { continue };
        let _ = write!(
            out,
            r#"<path d="M{x:.1} {TOP}v{}" stroke="currentColor" stroke-opacity="0.12"/><text x="{x:.1}" y="{}" text-anchor="middle">{text}</text>"#,
            Sheet::HIGH,
            TOP + Sheet::HIGH + 14.0
        );
    }
    for (value, text) in sheet.y.ticks() {
        let Some(share) = sheet.y.share(value) else { continue };
        let y = TOP + Sheet::HIGH * (1.0 - share);
        let _ = write!(
            out,
            r#"<path d="M{LEFT} {y:.1}h{}" stroke="currentColor" stroke-opacity="0.12"/><text x="{}" y="{:.1}" text-anchor="end">{text}</text>"#,
            Sheet::WIDE,
            LEFT - 5.0,
            y + 4.0
        );
    }
    let _ = write!(
        out,
        r#"<rect x="{LEFT}" y="{TOP}" width="{}" height="{}" fill="none" stroke="currentColor" stroke-opacity="0.5"/>"#,
        Sheet::WIDE,
        Sheet::HIGH
    );
}

fn draw_band(out: &mut String, sheet: &Sheet, band: &Band) {
    let place = |(x, y): (&f64, &f64)| sheet.at(*x, *y);
    let up: Vec<(f64, f64)> = band.x.iter().zip(&band.high).filter_map(place).collect();
    let down: Vec<(f64, f64)> = band.x.iter().zip(&band.low).rev().filter_map(place).collect();
    let mut path = String::new();
    for (x, y) in up.iter().chain(&down) {
        let _ = write!(path, "{}{x:.1} {y:.1}", if path.is_empty() { 'M' } else { 'L' });
    }
    if !path.is_empty() {
        let _ = write!(out, r#"<path d="{path}Z" fill="{}" fill-opacity="0.2"/>"#, colour(band.colour));
    }
}

fn draw_line(out: &mut String, sheet: &Sheet, line: &Line, colour: &str) {
    let mut path = String::new();
    let mut broken = true;
    for (x, y) in line.x.iter().zip(&line.y) {
        let Some((x, y)) = sheet.at(*x, *y) else {
            broken = true;
            continue;
        };
        let _ = match line.stroke {
            Stroke::Stems => write!(path, "M{x:.1} {:.1}V{y:.1}", TOP + Sheet::HIGH),
            Stroke::Solid | Stroke::Dashed => {
                write!(path, "{}{x:.1} {y:.1}", if broken { 'M' } else { 'L' })
            }
        };
        broken = false;
    }
    let how = match line.stroke {
        Stroke::Solid => r#"stroke-width="1.4""#,
        Stroke::Dashed => r#"stroke-width="1.4" stroke-dasharray="5 3""#,
        Stroke::Stems => r#"stroke-width="2""#,
    };
    let _ = write!(out, r#"<path d="{path}" fill="none" stroke="{colour}" {how}/>"#);
}

fn legend(out: &mut String, panel: &Panel) {
    let x = LEFT + Sheet::WIDE + 8.0;
    let mut y = TOP + 10.0;
    let mut entry = |mark: &str, label: &str| {
        let short: String = label.chars().take(LEGEND_LETTERS).collect();
        let _ = write!(
            out,
            r#"<g transform="translate({x} {y})">{mark}<text x="20" y="4">{}</text></g>"#,
            markup(&short)
        );
        y += 16.0;
    };
    for (index, line) in panel.lines.iter().enumerate().filter(|(_, line)| !line.label.is_empty()) {
        let dashes = if line.stroke == Stroke::Dashed { r#" stroke-dasharray="5 3""# } else { "" };
        let colour = colour(line.colour.unwrap_or(index));
        entry(&format!(r#"<path d="M0 0h16" stroke="{colour}" stroke-width="2"{dashes}/>"#), &line.label);
    }
    if !panel.spans.is_empty() && !panel.spans_label.is_empty() {
        let mark = r##"<rect y="-5" width="16" height="10" fill="#e69f00" fill-opacity="0.3"/>"##;
        entry(mark, &panel.spans_label);
    }
}
