//! Horizontal bars, several series a name.

use super::colour::colour;
use super::frame::{WIDTH, framed};
use crate::text::markup;
use std::fmt::Write;

/// Bars from zero to the right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// over them
    pub title: String,
    /// unit of the values
    pub unit: String,
    /// name of each group
    pub names: Vec<String>,
    /// label, which of the colours, and one value a name; what is not finite is left out
    pub series: Vec<(String, usize, Vec<f64>)>,
}

const LEFT: f64 = 130.0;
const RIGHT: f64 = 130.0;
const TOP: f64 = 26.0;
const BAR: f64 = 11.0;
const SPACE: f64 = 8.0;

impl Bars {
    /// An element for a page.
    #[must_use]
    pub fn inline(&self) -> String {
        let group = BAR * self.series.len() as f64 + SPACE;
        let height = TOP + group * self.names.len() as f64 + 8.0;
        framed(height, &self.title, &mut |out| self.draw(out, group))
    }

    fn draw(&self, out: &mut String, group: f64) {
        let all = self.series.iter().flat_map(|(.., values)| values).filter(|value| value.is_finite());
        let most = all.fold(f64::MIN_POSITIVE, |most, value| most.max(*value));
        let _ = write!(out, r#"<text x="8" y="16" font-weight="bold">{}</text>"#, markup(&self.title));
        for (place, name) in self.names.iter().enumerate() {
            let y = TOP + group * place as f64;
            let _ = write!(
                out,
                r#"<text x="{}" y="{:.1}" text-anchor="end">{}</text>"#,
                LEFT - 8.0,
                y + group / 2.0,
                markup(name)
            );
            for (index, (_, hue, values)) in self.series.iter().enumerate() {
                let Some(value) = values.get(place).filter(|value| value.is_finite()) else { continue };
                let wide = (WIDTH - LEFT - RIGHT) * (value / most).max(0.0);
                let top = y + BAR * index as f64;
                let _ = write!(
                    out,
                    r#"<rect x="{LEFT}" y="{top:.1}" width="{wide:.1}" height="{}" fill="{}"/><text x="{:.1}" y="{:.1}" font-size="9">{} {}</text>"#,
                    BAR - 1.5,
                    colour(*hue),
                    LEFT + wide + 4.0,
                    top + BAR - 3.0,
                    crate::report::number::significant(*value, 2),
                    markup(&self.unit)
                );
            }
        }
        for (index, (label, hue, _)) in self.series.iter().enumerate() {
            let y = TOP + 4.0 + 16.0 * index as f64;
            let _ = write!(
                out,
                r#"<rect x="{}" y="{}" width="16" height="8" fill="{}"/><text x="{}" y="{}">{}</text>"#,
                WIDTH - RIGHT + 44.0,
                y - 7.0,
                colour(*hue),
                WIDTH - RIGHT + 64.0,
                y,
                markup(label)
            );
        }
    }
}
