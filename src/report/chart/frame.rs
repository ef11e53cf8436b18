//! The frame of a chart in a page: its width, and its title for those who cannot see it.

use maud::{Markup, html};

/// Dots.
/// Largest number of points of a line: a chart is about 440 dots wide.
pub const POINTS: usize = 900;
pub(super) const WIDTH: f64 = 640.0;

/// An element for a page with a title for those who cannot see it.
pub(super) fn framed(height: f64, title: &str, drawing: &Markup) -> Markup {
    html! {
        svg viewBox={ "0 0 " (WIDTH) " " (height.round()) } role="img" fill="currentColor" {
            title { (title) }
            (drawing)
        }
    }
}

/// A position rounded to a tenth of a dot.
pub(super) fn tenths(value: f64) -> String {
    format!("{value:.1}")
}
