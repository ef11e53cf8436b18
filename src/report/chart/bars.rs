//! Horizontal bars, with several series for each name.

use super::colour::colour;
use super::draw::{LETTER, MARK, TOP};
use super::frame::{WIDTH, framed, tenths};
use crate::report::number::significant;
use maud::{Markup, html};

/// Bars from zero to the right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// title
    pub title: String,
    /// unit of the values
    pub unit: String,
    /// name of each group
    pub names: Vec<String>,
    /// label, index of the colour, and one value for each name; values that are not finite are left out
    pub series: Vec<(String, usize, Vec<f64>)>,
}

const LEFT: f64 = 130.0;
const RIGHT: f64 = 70.0;
const BAR: f64 = 11.0;
const SPACE: f64 = 8.0;

impl Bars {
    /// An element for a page.
    #[must_use]
    pub fn inline(&self) -> Markup {
        let group = BAR * self.series.len() as f64 + SPACE;
        let height = TOP + group * self.names.len() as f64 + 8.0;
        framed(height, &self.title, &self.drawing(group))
    }

    fn drawing(&self, group: f64) -> Markup {
        // one beside the other, above the bars
        let places = self.series.iter().scan(LEFT, |at, (label, ..)| {
            let from = *at;
            *at += MARK + LETTER * label.chars().count() as f64;
            Some(from)
        });
        html! {
            text x="8" y="16" font-weight="bold" { (self.title) }
            @for (place, name) in self.names.iter().enumerate() {
                (self.group(place, name, TOP + group * place as f64, group))
            }
            @for (x, (label, hue, _)) in places.zip(&self.series) {
                rect x=(tenths(x)) y=(TOP - 19.0) width="16" height="8" fill=(colour(*hue)) {}
                text x=(tenths(x + 20.0)) y=(TOP - 11.0) { (label) }
            }
        }
    }

    /// A name with one bar for each series.
    fn group(&self, place: usize, name: &str, y: f64, group: f64) -> Markup {
        let all = self.series.iter().flat_map(|(.., values)| values).filter(|value| value.is_finite());
        let most = all.fold(f64::MIN_POSITIVE, |most, value| most.max(*value));
        let bars = self.series.iter().enumerate().filter_map(|(index, (_, hue, values))| {
            let value = *values.get(place).filter(|value| value.is_finite())?;
            let wide = (WIDTH - LEFT - RIGHT) * (value / most).max(0.0);
            Some((y + BAR * index as f64, wide, *hue, format!("{} {}", significant(value, 2), self.unit)))
        });
        html! {
            text x=(LEFT - 8.0) y=(tenths(y + group / 2.0)) text-anchor="end" { (name) }
            @for (top, wide, hue, value) in bars {
                rect x=(LEFT) y=(tenths(top)) width=(tenths(wide)) height=(BAR - 1.5) fill=(colour(hue)) {}
                text x=(tenths(LEFT + wide + 4.0)) y=(tenths(top + BAR - 3.0)) font-size="9" { (value) }
            }
        }
    }
}
