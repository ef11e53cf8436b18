//! Search with random starts and random moves inside the limits, because the gradient of the distance is expensive.

use super::foresight::Foresight;
use super::settings::NextSettings;
use crate::plan::{
    AxisStart, Bound, Dynamics, Instant, ROTOR_MARGINS, RotorMargin, SeriesSpace, bounds_to_plan_in,
};
use crate::trajectory::FourierTrajectory;
use crate::vehicle::{Limits, Vehicle};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// Instants of a period at which the bounds are checked. A number of steps: only the time of a search and its last
/// digits depend on it.
const INSTANTS: u32 = 100;
/// Share of each bound's scale that is kept free, for the times between the instants.
const SPARE: f64 = 0.02;
/// Margin to the rotors' bounds with which a simulated flight stays off them, for a thrust-to-weight ratio of 2.
const ROTOR_MARGIN: RotorMargin = ROTOR_MARGINS[2];
/// Halvings of a factor.
const HALVINGS: u32 = 14;
/// First size of a move, relative to the series. It shrinks by [`SHRINK`] when a move fails. A number of steps: only
/// the time of a search and its last digits depend on it.
const MOVE: f64 = 0.5;
/// Factor on the size of a move after a failure. A step size: nearer to one the search is longer and more thorough. The
/// trajectory that it proposes depends on it, and its stated gain is that of this trajectory.
const SHRINK: f64 = 0.97;

/// The best series and the distance of every pair.
pub(super) fn best(
    foresight: &Foresight,
    limits: &Limits,
    vehicle: &Vehicle,
    (settings, step): (&NextSettings, &(dyn Fn() + Sync)),
) -> Option<(FourierTrajectory, Vec<f64>)> {
    let room = Room::new(foresight, limits, vehicle, settings);
    (0..settings.starts)
        .into_par_iter()
        .filter_map(|start| climb(foresight, &room, (settings, step), start))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(trajectory, _, distances)| (trajectory, distances))
}

/// Random flights that are assessed before one is searched. A number of steps: only the time of a search and its last
/// digits depend on it.
const PROBES: u64 = 6;

/// The largest distance of every question over a few random flights that fill the room; none if no flight can be
/// simulated.
pub(super) fn probed(
    foresight: &Foresight,
    limits: &Limits,
    vehicle: &Vehicle,
    settings: &NextSettings,
) -> Vec<f64> {
    let room = Room::new(foresight, limits, vehicle, settings);
    let each: Vec<Vec<f64>> = (0..PROBES)
        .into_par_iter()
        .filter_map(|probe| {
            let seed = settings.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_sub(probe + 1);
            let unknowns = room.drawn(&mut Pcg64Mcg::seed_from_u64(seed))?;
            foresight.distances(&room.space.trajectory(&unknowns))
        })
        .collect();
    let most = |mut most: Vec<f64>, one: Vec<f64>| {
        most.iter_mut().zip(one).for_each(|(most, one)| *most = most.max(one));
        most
    };
    each.into_iter().reduce(most).unwrap_or_default()
}

/// Series that start and end at rest in the middle of the room, with their bounds.
struct Room {
    space: SeriesSpace,
    bounds: Vec<Bound>,
    dynamics: Dynamics,
}

impl Room {
    fn new(foresight: &Foresight, limits: &Limits, vehicle: &Vehicle, settings: &NextSettings) -> Self {
        let height = match (limits.z_min_m, limits.z_max_m) {
            (Some(low), Some(high)) => f64::midpoint(low, high),
            (Some(low), None) => low + 1.0,
            (None, Some(high)) => 0.5 * high,
            (None, None) => 1.5,
        };
        // x, y and yaw stay near zero; where in height it hovers is free
        let start = [AxisStart::At(0.0), AxisStart::At(0.0), AxisStart::Near(height), AxisStart::At(0.0)];
        Self {
            space: SeriesSpace::new(settings.period_s, settings.harmonics, start),
            bounds: bounds_to_plan_in(limits, vehicle, ROTOR_MARGIN),
            dynamics: Dynamics::new(&foresight.base().vehicle),
        }
    }

    fn keeps(&self, unknowns: &DVector<f64>) -> bool {
        let trajectory = self.space.trajectory(unknowns);
        (0..INSTANTS).all(|k| {
            let time_s = self.space.period_s() * f64::from(k) / f64::from(INSTANTS);
            let instant = Instant::new(trajectory.derivatives(time_s), &self.dynamics);
            self.bounds.iter().all(|bound| {
                let value = instant.value(bound.quantity, &self.dynamics);
                let spare = SPARE * bound.scale();
                value.is_finite()
                    && bound.min.is_none_or(|min| value >= min + spare.min(0.5 * bound.scale()))
                    && bound.max.is_none_or(|max| value <= max - spare)
            })
        })
    }

    /// The series scaled as large as the bounds allow, because larger motion gives more information.
    fn filled(&self, unknowns: &DVector<f64>) -> Option<DVector<f64>> {
        let (mut low, mut high) = (0.0, 4.0);
        if self.keeps(&(unknowns * high)) {
            return Some(unknowns * high);
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if self.keeps(&(unknowns * middle)) { low = middle } else { high = middle }
        }
        (low > 0.0).then(|| unknowns * low)
    }

    /// A random series with each axis scaled separately and then all together, so that no axis is small because another
    /// is at its bound.
    fn drawn(&self, random: &mut Pcg64Mcg) -> Option<DVector<f64>> {
        let mut sum = DVector::zeros(self.space.dimension());
        for axis in 0..4 {
            let mut alone = DVector::zeros(self.space.dimension());
            for index in self.space.unknowns_of(axis) {
                alone[index] = random.random_range(-1.0..1.0);
            }
            if let Some(filled) = self.filled(&alone) {
                sum += filled;
            }
        }
        self.filled(&sum)
    }
}

/// One start: moves of one axis at a time are kept if the smallest distance increases.
fn climb(
    foresight: &Foresight,
    room: &Room,
    (settings, step): (&NextSettings, &(dyn Fn() + Sync)),
    start: u64,
) -> Option<(FourierTrajectory, f64, Vec<f64>)> {
    let seed = settings.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(start);
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let judge = |unknowns: &DVector<f64>| {
        let trajectory = room.space.trajectory(unknowns);
        let distances = foresight.distances(&trajectory)?;
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        least.is_finite().then_some((trajectory, least, distances))
    };
    let mut at = room.drawn(&mut random)?;
    let mut best = judge(&at)?;
    let mut size = MOVE;
    for _ in 0..settings.moves {
        let axis = random.random_range(0..4_usize);
        let range = room.space.unknowns_of(axis);
        let scale = size * at.rows(range.start, range.len()).amax().max(0.1 * at.amax());
        let mut trial = at.clone();
        for index in range {
            trial[index] += scale * random.random_range(-1.0..1.0);
        }
        let judged = room.filled(&trial).and_then(|trial| judge(&trial).map(|judged| (trial, judged)));
        match judged {
            Some((trial, judged)) if judged.1 > best.1 => {
                (at, best) = (trial, judged);
            }
            _ => size = (size * SHRINK).max(0.05),
        }
        step();
    }
    Some(best)
}
