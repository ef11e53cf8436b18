//! A path in three dimensions, coloured by a value: drawn from one side, turned by the page's script.

use super::data::data;
use super::frame::{WIDTH, framed, tenths};
use crate::report::number::significant;
use crate::text::to_step;
use maud::{Markup, html};
use serde::Serialize;

/// Dots.
const HEIGHT: f64 = 316.0;
/// Dots above and below the path, for words and the legend.
const ABOVE: f64 = 58.0;
const BELOW: f64 = 38.0;
/// Dots between a colour of the legend and the next one.
const APART: f64 = 90.0;
/// The view of the drawing: turned about the vertical and tilted, rad.
const TURNED: f64 = 0.7;
const TILTED: f64 = 0.5;
/// Segments with a colour of their own at most.
const SEGMENTS: usize = 400;
/// From little to much: of one hue's lightness alone, so that all people tell them apart, on light and dark.
const RAMP: [&str; 5] = ["#3b6fb6", "#6f9bc4", "#b3ad85", "#e0a030", "#d55e00"];

/// A path coloured by a value.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Path3 {
    /// title
    pub title: String,
    /// s
    pub time_s: Vec<f64>,
    /// m, z upwards
    pub position_m: Vec<[f64; 3]>,
    /// names of the axes
    pub axes: [String; 3],
    /// what it may be coloured by
    pub values: Vec<PathValue>,
    /// words for the unit of the values
    pub unit: String,
    /// plots with this number share its cursor
    pub cursor: usize,
    /// colours from little to much
    pub ramp: Vec<&'static str>,
}

/// A value along a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct PathValue {
    name: String,
    /// one a point
    along: Vec<f64>,
    /// where each colour but the first begins
    begins: Vec<f64>,
    /// words of the legend, one a colour
    classes: Vec<String>,
    /// what the colours are to be read with
    words: String,
}

impl PathValue {
    /// A value with its name, coloured in even steps between two ends. What is beyond an end has the colour of it.
    #[must_use]
    pub fn new((name, along): (&str, Vec<f64>), [low, high]: [f64; 2], words: String) -> Self {
        let step = (high - low) / RAMP.len() as f64;
        let begins: Vec<f64> = (1..RAMP.len()).map(|place| low + step * place as f64).collect();
        let said: Vec<String> = begins.iter().map(|begin| to_step(*begin, step)).collect();
        let below = said.first().map(|first| format!("below {first}"));
        let classes = below.into_iter().chain(said.iter().map(|begin| format!("from {begin}"))).collect();
        Self { name: name.to_owned(), along, begins, classes, words }
    }

    fn colour(&self, value: f64) -> &'static str {
        RAMP[self.begins.iter().filter(|begin| value >= **begin).count()]
    }
}

impl Path3 {
    /// An element for a page, coloured by the first value.
    #[must_use]
    pub fn inline(&self) -> Markup {
        let of_script = Self { ramp: RAMP.to_vec(), ..self.thinned() };
        html! {
            div.path3 { (framed(HEIGHT, &self.title, &self.drawing())) (data(&of_script)) }
        }
    }

    /// So many points that each segment can be seen, with few digits.
    fn thinned(&self) -> Self {
        let every = self.time_s.len().div_ceil(SEGMENTS).max(1);
        let short = |value: &f64| significant(*value, 4).parse().unwrap_or(0.0);
        Self {
            time_s: self.time_s.iter().step_by(every).map(short).collect(),
            position_m: self.position_m.iter().step_by(every).map(|at| at.each_ref().map(short)).collect(),
            values: self
                .values
                .iter()
                .map(|of| PathValue {
                    along: of.along.iter().step_by(every).map(short).collect(),
                    ..of.clone()
                })
                .collect(),
            ..self.clone()
        }
    }

    fn drawing(&self) -> Markup {
        let thin = self.thinned();
        let flat: Vec<(f64, f64)> = thin.position_m.iter().map(|at| projected(*at)).collect();
        let (low, high) =
            flat.iter().fold(((f64::MAX, f64::MAX), (f64::MIN, f64::MIN)), |(low, high), at| {
                ((low.0.min(at.0), low.1.min(at.1)), (high.0.max(at.0), high.1.max(at.1)))
            });
        let room = (WIDTH - 60.0, HEIGHT - ABOVE - BELOW);
        let scale = (room.0 / (high.0 - low.0).max(1e-6)).min(room.1 / (high.1 - low.1).max(1e-6));
        let at = |(x, y): (f64, f64)| {
            let middle = (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1));
            (WIDTH / 2.0 + scale * (x - middle.0), ABOVE + room.1 / 2.0 + scale * (y - middle.1))
        };
        html! {
            text x="8" y="16" font-weight="bold" { (self.title) }
            text x="8" y="33" { (self.spans()) }
            @if let Some(value) = thin.values.first() {
                text x="8" y="49" { (value.name) ": " (value.words) }
                @for (pair, of) in flat.windows(2).zip(&value.along) {
                    @let ((x, y), (to_x, to_y)) = (at(pair[0]), at(pair[1]));
                    path d={ "M" (tenths(x)) " " (tenths(y)) "L" (tenths(to_x)) " " (tenths(to_y)) }
                        stroke=(value.colour(*of)) stroke-width="2.2" stroke-linecap="round" {}
                }
                @for (place, (colour, class)) in RAMP.iter().zip(&value.classes).enumerate() {
                    rect x=(tenths(8.0 + APART * place as f64)) y=(HEIGHT - 22.0) width="14" height="10" fill=(colour) {}
                    text x=(tenths(26.0 + APART * place as f64)) y=(HEIGHT - 13.0) { (class) }
                }
                text x=(tenths(8.0 + APART * RAMP.len() as f64)) y=(HEIGHT - 13.0) { (self.unit) }
            }
        }
    }

    /// How far it goes along each axis: a drawing that nobody turns shows no lengths.
    fn spans(&self) -> String {
        let one = |axis: usize| {
            let places = self.position_m.iter().map(|at| at[axis]);
            let (low, high) =
                places.fold((f64::MAX, f64::MIN), |(low, high), place| (low.min(place), high.max(place)));
            format!("{} {} m", self.axes[axis], significant((high - low).max(0.0), 2))
        };
        format!("spans {}", [0, 1, 2].map(one).join(", "))
    }
}

/// A point on the sheet, y downwards.
fn projected([north, west, up]: [f64; 3]) -> (f64, f64) {
    let right = -west * TURNED.cos() + north * TURNED.sin();
    let depth = north * TURNED.cos() + west * TURNED.sin();
    (right, -up * TILTED.cos() - depth * TILTED.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_even_steps_between_the_ends_and_beyond_them_those_of_the_ends() {
        let value = PathValue::new(("rigid body", vec![28.0, 100.0]), [28.0, 35.0], "words".to_owned());
        assert_eq!(value.classes, ["below 29.4", "from 29.4", "from 30.8", "from 32.2", "from 33.6"]);
        let colours = [0.0, 28.0, 30.0, 34.0, 1000.0].map(|of| value.colour(of));
        assert_eq!(colours, [RAMP[0], RAMP[0], RAMP[1], RAMP[4], RAMP[4]]);
        let path = Path3 {
            time_s: vec![0.0, 1.0, 2.0],
            position_m: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
            values: vec![value],
            unit: "times".to_owned(),
            ..Path3::default()
        };
        let page = path.inline().into_string();
        assert!(page.contains("rigid body: words") && page.contains("below 29.4"), "{page}");
        assert_eq!(page.matches("stroke-width=\"2.2\"").count(), 2, "{page}");
    }
}
