//! The frame of a chart in a page: its width, and its title for those who cannot see it.

use maud::{Markup, html};

/// Largest number of points of a line: a chart is about 440 dots wide.
pub const POINTS: usize = 900;
/// Dots.
pub(super) const WIDTH: f64 = 640.0;

/// An element for a page with a title for those who cannot see it.
pub(super) fn framed(height: f64, title: &str, drawing: &Markup) -> Markup {
    framed_as("chart", (WIDTH, height), title, drawing)
}

/// The same of another width, with the class by which the page's style knows its kind.
pub(super) fn framed_as(kind: &str, (width, height): (f64, f64), title: &str, drawing: &Markup) -> Markup {
    html! {
        svg class=(kind) viewBox={ "0 0 " (width) " " (height.round()) } role="img" fill="currentColor" {
            title { (title) }
            (drawing)
        }
    }
}

/// A position rounded to a tenth of a dot.
pub(super) fn tenths(value: f64) -> String {
    format!("{value:.1}")
}
