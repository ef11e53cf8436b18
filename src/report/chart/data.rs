//! The numbers of a panel: for the script of the page, and as a table for those who cannot see the drawing.

use super::panel::{Line, Panel, Stroke};
use crate::report::number::significant;
use crate::text::json_line;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

/// Digits of a number that the script shows.
const DIGITS: i32 = 5;
/// Rows of a table.
const ROWS: usize = 12;

#[derive(Serialize)]
struct PanelValue<'a> {
    title: &'a str,
    x_label: &'a str,
    y_label: &'a str,
    cursor: Option<usize>,
    log: (bool, bool),
    lines: Vec<LineValue<'a>>,
    bands: Vec<BandValue>,
    spans: &'a [[f64; 2]],
    spans_label: &'a str,
}

#[derive(Serialize)]
struct LineValue<'a> {
    label: &'a str,
    colour: usize,
    stroke: &'static str,
    /// none where it is that of the line before
    x: Option<Vec<Option<f64>>>,
    y: Vec<Option<f64>>,
}

#[derive(Serialize)]
struct BandValue {
    colour: usize,
    x: Vec<Option<f64>>,
    low: Vec<Option<f64>>,
    high: Vec<Option<f64>>,
}

/// Numbers as they are shown; `None` where they are not finite.
fn rounded(values: &[f64]) -> Vec<Option<f64>> {
    values
        .iter()
        .map(|value| significant(*value, DIGITS).parse().ok().filter(|value: &f64| value.is_finite()))
        .collect()
}

/// The numbers of a panel in an element that only the page's script reads.
pub(super) fn numbers(panel: &Panel) -> Markup {
    let lines = panel.lines.iter().enumerate().map(|(index, line)| LineValue {
        label: &line.label,
        colour: line.colour.unwrap_or(index),
        stroke: match line.stroke {
            Stroke::Solid => "solid",
            Stroke::Dashed => "dashed",
            Stroke::Stems => "stems",
            Stroke::Dots => "dots",
        },
        x: (index == 0 || panel.lines[index - 1].x != line.x).then(|| rounded(&line.x)),
        y: rounded(&line.y),
    });
    let bands = panel.bands.iter().map(|band| BandValue {
        colour: band.colour,
        x: rounded(&band.x),
        low: rounded(&band.low),
        high: rounded(&band.high),
    });
    data(&PanelValue {
        title: &panel.title,
        x_label: &panel.x_label,
        y_label: &panel.y_label,
        cursor: panel.cursor,
        log: panel.log,
        lines: lines.collect(),
        bands: bands.collect(),
        spans: &panel.spans,
        spans_label: &panel.spans_label,
    })
}

/// A value in an element of the page that the script reads: no `<` of it ends the element.
pub(super) fn data(value: &impl Serialize) -> Markup {
    let text = json_line(value).unwrap_or_default().replace('<', "\\u003c");
    html! { script type="application/json" { (PreEscaped(text)) } }
}

/// At most some rows of a panel's numbers, folded.
fn shown(line: &Line) -> impl Iterator<Item = usize> + Clone {
    (0..line.x.len()).step_by(line.x.len().div_ceil(ROWS).max(1))
}

/// The numbers as a table, folded.
pub(super) fn table(panel: &Panel) -> Markup {
    let groups = panel.lines.chunk_by(|a, b| a.x == b.x);
    html! {
        details.numbers {
            summary { "Numbers of this plot: " (panel.title) }
            @for group in groups {
                div.wide { table {
                    thead { tr {
                        th.n { (panel.x_label) }
                        @for line in group { th.n { (line.label) " (" (panel.y_label) ")" } }
                    } }
                    tbody { @for row in group.first().into_iter().flat_map(shown) { tr {
                        td.n { (group.first().map_or_else(String::new, |line| significant(line.x[row], 4))) }
                        @for line in group {
                            td.n { (line.y.get(row).filter(|y| y.is_finite()).map_or_else(|| "-".to_owned(), |y| significant(*y, 3))) }
                        }
                    } } }
                } }
            }
        }
    }
}
