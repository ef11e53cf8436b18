//! Rows of cells over time; larger values are darker.

use super::axis::Axis;
use super::frame::{framed_as, tenths};
use maud::{Markup, html};

/// A heat map along an abscissa.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strip {
    /// title
    pub title: String,
    /// with its unit
    pub x_label: String,
    /// centre of each cell, evenly spaced
    pub x: Vec<f64>,
    /// name, and one value for each cell; cells with values that are not finite stay empty
    pub rows: Vec<(String, Vec<f64>)>,
    /// value that is darkest
    pub full: f64,
}

/// Dots: so narrow that its words are legible on a phone.
const WIDTH: f64 = 400.0;
const LEFT: f64 = 104.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 26.0;
const ROW: f64 = 16.0;
/// Cells fainter than this are not drawn.
const LEAST_DARK: f64 = 0.02;

impl Strip {
    /// An element for a page.
    #[must_use]
    pub fn inline(&self) -> Markup {
        let height = TOP + ROW * self.rows.len() as f64 + 40.0;
        framed_as("strip", (WIDTH, height), &self.title, &self.drawing())
    }

    fn drawing(&self) -> Markup {
        let wide = WIDTH - LEFT - RIGHT;
        let cell = wide / self.x.len().max(1) as f64;
        let high = ROW * self.rows.len() as f64;
        let axis = Axis::covering(self.x.iter().copied(), 0.0, false);
        let ticks = axis
            .ticks()
            .into_iter()
            .filter_map(|(value, text)| Some((LEFT + cell / 2.0 + (wide - cell) * axis.share(value)?, text)));
        html! {
            text x="8" y="16" font-weight="bold" { (self.title) }
            @for (place, (name, values)) in self.rows.iter().enumerate() {
                (self.row(TOP + ROW * place as f64, cell, name, values))
            }
            rect x=(LEFT) y=(TOP) width=(wide) height=(high) fill="none" stroke="currentColor" stroke-opacity="0.5" {}
            text x=(LEFT + wide / 2.0) y=(TOP + high + 32.0) text-anchor="middle" { (self.x_label) }
            @for (x, text) in ticks {
                text x=(tenths(x)) y=(TOP + high + 14.0) text-anchor="middle" { (text) }
            }
        }
    }

    /// A name with its cells.
    fn row(&self, y: f64, cell: f64, name: &str, values: &[f64]) -> Markup {
        let dark = |value: &f64| (value / self.full).clamp(0.0, 1.0);
        let seen = values.iter().map(dark).enumerate().filter(|(_, dark)| *dark > LEAST_DARK);
        html! {
            text x=(LEFT - 8.0) y=(tenths(y + 12.0)) text-anchor="end" { (name) }
            @for (index, dark) in seen {
                rect x=(tenths(LEFT + cell * index as f64)) y=(y) width=(tenths(cell + 0.3)) height=(ROW - 2.0)
                    fill="#d55e00" fill-opacity=(format_args!("{dark:.2}")) {}
            }
        }
    }
}
