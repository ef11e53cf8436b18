//! A panel: axes, shading, bands, lines, legend.

use super::axis::Axis;
use super::colour::colour;
use super::frame::{WIDTH, tenths};
use super::panel::{Band, Line, Panel, Stroke};
use maud::{Markup, html};
use std::fmt::Write;

/// Dots.
pub(super) const HEIGHT: f64 = 244.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 12.0;
pub(super) const TOP: f64 = 42.0;
const BOTTOM: f64 = 40.0;
/// Dots of a letter of the legend, and of its mark with the space around it.
pub(super) const LETTER: f64 = 6.2;
pub(super) const MARK: f64 = 38.0;

/// Positions on the sheet.
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

pub(super) fn drawing(panel: &Panel) -> Markup {
    let xs = panel.lines.iter().flat_map(|line| &line.x).chain(panel.bands.iter().flat_map(|band| &band.x));
    let ys = panel.lines.iter().flat_map(|line| &line.y);
    let ys = ys.chain(panel.bands.iter().flat_map(|band| band.low.iter().chain(&band.high)));
    let sheet = Sheet {
        x: Axis::covering(xs.copied(), 0.0, panel.log.0),
        y: Axis::covering(ys.copied(), 0.05, panel.log.1),
    };
    html! {
        (words(panel))
        @for span in &panel.spans { (shading(&sheet, *span)) }
        (grid(&sheet))
        @for band in &panel.bands { (band_path(&sheet, band)) }
        @for (index, line) in panel.lines.iter().enumerate() {
            (line_path(&sheet, line, colour(line.colour.unwrap_or(index))))
        }
        (legend(panel))
    }
}

fn words(panel: &Panel) -> Markup {
    let (middle_x, middle_y) = (LEFT + Sheet::WIDE / 2.0, TOP + Sheet::HIGH / 2.0);
    html! {
        text x=(LEFT) y="16" font-weight="bold" { (panel.title) }
        text x=(middle_x) y=(HEIGHT - 6.0) text-anchor="middle" { (panel.x_label) }
        text transform={ "translate(14 " (middle_y) ") rotate(-90)" } text-anchor="middle" { (panel.y_label) }
    }
}

/// A shaded interval of the abscissa.
fn shading(sheet: &Sheet, [from, to]: [f64; 2]) -> Markup {
    let (Some(from), Some(to)) = (sheet.x_at(from), sheet.x_at(to)) else { return Markup::default() };
    let (from, to) = (from.max(LEFT), to.min(LEFT + Sheet::WIDE));
    html! {
        rect.span x=(tenths(from)) y=(TOP) width=(tenths((to - from).max(1.0))) height=(Sheet::HIGH)
            fill="#e69f00" fill-opacity="0.22" {}
    }
}

fn grid(sheet: &Sheet) -> Markup {
    let upright = sheet.x.ticks().into_iter().filter_map(|(value, text)| Some((sheet.x_at(value)?, text)));
    let level = sheet
        .y
        .ticks()
        .into_iter()
        .filter_map(|(value, text)| Some((TOP + Sheet::HIGH * (1.0 - sheet.y.share(value)?), text)));
    html! {
        @for (x, text) in upright {
            path d={ "M" (tenths(x)) " " (TOP) "v" (Sheet::HIGH) } stroke="currentColor" stroke-opacity="0.12" {}
            text x=(tenths(x)) y=(TOP + Sheet::HIGH + 14.0) text-anchor="middle" { (text) }
        }
        @for (y, text) in level {
            path d={ "M" (LEFT) " " (tenths(y)) "h" (Sheet::WIDE) } stroke="currentColor" stroke-opacity="0.12" {}
            text x=(LEFT - 5.0) y=(tenths(y + 4.0)) text-anchor="end" { (text) }
        }
        rect x=(LEFT) y=(TOP) width=(Sheet::WIDE) height=(Sheet::HIGH) fill="none" stroke="currentColor"
            stroke-opacity="0.5" {}
    }
}

fn band_path(sheet: &Sheet, band: &Band) -> Markup {
    let place = |(x, y): (&f64, &f64)| sheet.at(*x, *y);
    let up: Vec<(f64, f64)> = band.x.iter().zip(&band.high).filter_map(place).collect();
    let down: Vec<(f64, f64)> = band.x.iter().zip(&band.low).rev().filter_map(place).collect();
    let mut path = String::new();
    for (x, y) in up.iter().chain(&down) {
        let _ = write!(path, "{}{x:.1} {y:.1}", if path.is_empty() { 'M' } else { 'L' });
    }
    html! {
        @if !path.is_empty() { path d={ (path) "Z" } fill=(colour(band.colour)) fill-opacity="0.2" {} }
    }
}

fn line_path(sheet: &Sheet, line: &Line, colour: &str) -> Markup {
    let mut path = String::new();
    let mut broken = true;
    for (x, y) in line.x.iter().zip(&line.y) {
        let Some((x, y)) = sheet.at(*x, *y) else {
            broken = true;
            continue;
        };
        let _ = match line.stroke {
            Stroke::Stems => write!(path, "M{x:.1} {:.1}V{y:.1}", TOP + Sheet::HIGH),
            Stroke::Dots => write!(path, "M{:.1} {y:.1}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0", x - 3.0),
            Stroke::Solid | Stroke::Dashed => {
                write!(path, "{}{x:.1} {y:.1}", if broken { 'M' } else { 'L' })
            }
        };
        broken = false;
    }
    let width = if line.stroke == Stroke::Stems { "2" } else { "1.4" };
    html! {
        path d=(path) fill="none" stroke=(colour) stroke-width=(width) stroke-dasharray=[dashes(line.stroke)] {}
    }
}

/// A dot in the legend.
const DOT: &str = "M5 0a3 3 0 1 0 6 0a3 3 0 1 0 -6 0";

/// The pattern of a broken line.
fn dashes(stroke: Stroke) -> Option<&'static str> {
    (stroke == Stroke::Dashed).then_some("5 3")
}

fn legend(panel: &Panel) -> Markup {
    let lines = panel.lines.iter().enumerate().filter(|(_, line)| !line.label.is_empty());
    let mut entries: Vec<(Markup, &str)> = lines
        .map(|(index, line)| {
            let shape = if line.stroke == Stroke::Dots { DOT } else { "M0 0h16" };
            let mark = html! {
                path d=(shape) fill="none" stroke=(colour(line.colour.unwrap_or(index))) stroke-width="2"
                    stroke-dasharray=[dashes(line.stroke)] {}
            };
            (mark, line.label.as_str())
        })
        .collect();
    if !panel.spans.is_empty() && !panel.spans_label.is_empty() {
        let mark = html! { rect y="-5" width="16" height="10" fill="#e69f00" fill-opacity="0.3" {} };
        entries.push((mark, &panel.spans_label));
    }
    // one beside the other, above the axes
    let places = entries.iter().scan(LEFT, |at, (_, label)| {
        let from = *at;
        *at += MARK + LETTER * label.chars().count() as f64;
        Some(from)
    });
    html! {
        @for (x, (mark, label)) in places.zip(&entries) {
            g transform={ "translate(" (tenths(x)) " " (TOP - 12.0) ")" } {
                (mark)
                text x="20" y="4" { (label) }
            }
        }
    }
}
