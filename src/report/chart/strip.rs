//! Rows of cells along time, darker where more is.

use super::axis::Axis;
use super::frame::{WIDTH, framed};
use crate::text::markup;
use std::fmt::Write;

/// Heat along an abscissa.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Strip {
    /// over it
    pub title: String,
    /// with its unit
    pub x_label: String,
    /// centre of each cell, evenly spaced
    pub x: Vec<f64>,
    /// name, and one value a cell; what is not finite stays empty
    pub rows: Vec<(String, Vec<f64>)>,
    /// value that is darkest
    pub full: f64,
}

const LEFT: f64 = 130.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 26.0;
const ROW: f64 = 16.0;

impl Strip {
    /// An element for a page.
    #[must_use]
    pub fn inline(&self) -> String {
        let height = TOP + ROW * self.rows.len() as f64 + 40.0;
        framed(height, &self.title, &mut |out| self.draw(out))
    }

    fn draw(&self, out: &mut String) {
        let axis = Axis::covering(self.x.iter().copied(), 0.0, false);
        let cell = (WIDTH - LEFT - RIGHT) / self.x.len().max(1) as f64;
        let bottom = TOP + ROW * self.rows.len() as f64;
        let _ = write!(out, r#"<text x="8" y="16" font-weight="bold">{}</text>"#, markup(&self.title));
        for (place, (name, values)) in self.rows.iter().enumerate() {
            let y = TOP + ROW * place as f64;
            let _ = write!(
                out,
                r#"<text x="{}" y="{:.1}" text-anchor="end">{}</text>"#,
                LEFT - 8.0,
                y + 12.0,
                markup(name)
            );
            for (index, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                let dark = (value / self.full).clamp(0.0, 1.0);
                if dark > 0.02 {
                    let _ = write!(
                        out,
                        r##"<rect x="{:.1}" y="{y}" width="{:.1}" height="{}" fill="#d55e00" fill-opacity="{dark:.2}"/>"##,
                        LEFT + cell * index as f64,
                        cell + 0.3,
                        ROW - 2.0
                    );
                }
            }
        }
        let _ = write!(
            out,
            r#"<rect x="{LEFT}" y="{TOP}" width="{}" height="{}" fill="none" stroke="currentColor" stroke-opacity="0.5"/><text x="{}" y="{}" text-anchor="middle">{}</text>"#,
            WIDTH - LEFT - RIGHT,
            bottom - TOP,
            LEFT + (WIDTH - LEFT - RIGHT) / 2.0,
            bottom + 32.0,
            markup(&self.x_label)
        );
        for (value, text) in axis.ticks() {
            if let Some(share) = axis.share(value) {
                let x = LEFT + cell / 2.0 + (WIDTH - LEFT - RIGHT - cell) * share;
                let _ = write!(
                    out,
                    r#"<text x="{x:.1}" y="{}" text-anchor="middle">{text}</text>"#,
                    bottom + 14.0
                );
            }
        }
    }
}
