//! A path in three dimensions, coloured by a value: drawn from one side, turned by the page's script.

use super::data::data;
use super::frame::{WIDTH, framed, tenths};
use crate::report::number::significant;
use maud::{Markup, html};
use serde::Serialize;

/// Dots.
const HEIGHT: f64 = 300.0;
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
    /// names of the values, each with one a point
    pub values: Vec<(String, Vec<f64>)>,
    /// words for the unit of the values
    pub unit: String,
    /// value that has the last colour
    pub full: f64,
    /// plots with this number share its cursor
    pub cursor: usize,
    /// colours from little to much
    pub ramp: Vec<&'static str>,
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
                .map(|(name, of)| (name.clone(), of.iter().step_by(every).map(short).collect()))
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
        let room = (WIDTH - 60.0, HEIGHT - 80.0);
        let scale = (room.0 / (high.0 - low.0).max(1e-6)).min(room.1 / (high.1 - low.1).max(1e-6));
        let at = |(x, y): (f64, f64)| {
            let middle = (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1));
            (WIDTH / 2.0 + scale * (x - middle.0), HEIGHT / 2.0 + 10.0 + scale * (y - middle.1))
        };
        let colours = thin.values.first().map_or(&[][..], |(_, values)| values);
        html! {
            text x="8" y="16" font-weight="bold" { (self.title) }
            text x="8" y="33" { (self.spans()) }
            @for (pair, value) in flat.windows(2).zip(colours) {
                @let ((x, y), (to_x, to_y)) = (at(pair[0]), at(pair[1]));
                path d={ "M" (tenths(x)) " " (tenths(y)) "L" (tenths(to_x)) " " (tenths(to_y)) }
                    stroke=(self.colour(*value)) stroke-width="2.2" stroke-linecap="round" {}
            }
            @for (place, colour) in RAMP.iter().enumerate() {
                rect x=(tenths(8.0 + 90.0 * place as f64)) y=(HEIGHT - 22.0) width="14" height="10" fill=(colour) {}
                text x=(tenths(26.0 + 90.0 * place as f64)) y=(HEIGHT - 13.0) { (self.class(place)) }
            }
            text x=(tenths(8.0 + 90.0 * RAMP.len() as f64)) y=(HEIGHT - 13.0) { (self.unit) }
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

    fn colour(&self, value: f64) -> &'static str {
        let share = (value / self.full.max(f64::MIN_POSITIVE)).max(0.0);
        let place = (1..RAMP.len()).rev().find(|&place| share * RAMP.len() as f64 >= place as f64);
        RAMP[place.unwrap_or(0)]
    }

    fn class(&self, place: usize) -> String {
        format!("from {}", significant(self.full * place as f64 / RAMP.len() as f64, 2))
    }
}

/// A point on the sheet, y downwards.
fn projected([north, west, up]: [f64; 3]) -> (f64, f64) {
    let right = -west * TURNED.cos() + north * TURNED.sin();
    let depth = north * TURNED.cos() + west * TURNED.sin();
    (right, -up * TILTED.cos() - depth * TILTED.sin())
}
