//! Horizontal bars, with several series for each name.

use super::colour::colour;
use super::draw::{LETTER, MARK, TOP};
use super::frame::{framed_as, tenths};
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

/// Dots: so narrow that its words are legible on a phone.
const WIDTH: f64 = 400.0;
const LEFT: f64 = 130.0;
const RIGHT: f64 = 44.0;
/// Of the title and of what the colours mean.
const MARGIN: f64 = 8.0;
/// Between lines of the legend.
const LINE: f64 = 14.0;
const BAR: f64 = 11.0;
const SPACE: f64 = 8.0;

impl Bars {
    /// An element for a page.
    #[must_use]
    pub fn inline(&self) -> Markup {
        let group = BAR * self.series.len() as f64 + SPACE;
        let (legend, lines) = self.legend();
        let top = TOP + LINE * (lines - 1) as f64;
        let height = top + group * self.names.len() as f64 + 8.0;
        let drawing = html! {
            text x=(MARGIN) y="16" font-weight="bold" { (self.title) }
            (legend)
            @for (place, name) in self.names.iter().enumerate() {
                (self.group(place, name, top + group * place as f64, group))
            }
        };
        framed_as("strip", (WIDTH, height), &self.title, &drawing)
    }

    /// What the colours mean, one beside the other while there is room, and its lines.
    fn legend(&self) -> (Markup, usize) {
        let (mut x, mut line) = (MARGIN, 0_u32);
        let mut places = Vec::new();
        for (label, hue, _) in &self.series {
            let wide = MARK + LETTER * label.chars().count() as f64;
            if x > MARGIN && x + wide > WIDTH {
                (x, line) = (MARGIN, line + 1);
            }
            places.push((x, TOP - 11.0 + LINE * f64::from(line), label, *hue));
            x += wide;
        }
        let drawing = html! {
            @for (x, y, label, hue) in places {
                rect x=(tenths(x)) y=(tenths(y - 8.0)) width="16" height="8" fill=(colour(hue)) {}
                text x=(tenths(x + 20.0)) y=(tenths(y)) { (label) }
            }
        };
        (drawing, line as usize + 1)
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
            text x=(LEFT - MARGIN) y=(tenths(y + group / 2.0)) text-anchor="end" { (name) }
            @for (top, wide, hue, value) in bars {
                rect x=(LEFT) y=(tenths(top)) width=(tenths(wide)) height=(BAR - 1.5) fill=(colour(hue)) {}
                text x=(tenths(LEFT + wide + 4.0)) y=(tenths(top + BAR - 3.0)) font-size="9" { (value) }
            }
        }
    }
}
