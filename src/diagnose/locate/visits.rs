//! Whether a force belongs to a place: other visits to the place show it again.

use super::super::channels::{CHANNELS, Channels};
use super::super::fit::Fitted;
use super::redness::{Quantity, RED_STATISTIC, Redness};
use crate::stats::{STRETCHES, median_step};
use nalgebra::{DMatrix, DVector};

/// Number of these parts in which a field must explain something. Set by judgement; measured only together with all
/// conditions of a finding (see `Gates`).
const LEAST_STRETCHES: usize = 8;
/// Least share of what a field explains that the other parts of the flight must predict. Set by judgement; measured only together with all
/// conditions of a finding (see `Gates`).
const PREDICTED: f64 = 0.5;
/// Correlation times after which a force that wanders by itself is another one: a seventh of it is left then.
const FORGOTTEN: f64 = 2.0;
/// Share of the range of positions that a vehicle must move away before it visits a place again.
const AWAY: f64 = 0.25;
/// Ridge of that prediction, as a share of a column's mean energy.
const UNSEEN: f64 = 0.01;

/// Correlation time of what wanders by itself along a world axis, s; 0 where nothing does.
pub(super) fn wanders_s(redness: &[Redness], component: usize) -> f64 {
    let along = |of: Quantity| match of {
        Quantity::World(axis) => axis == component,
        Quantity::BodyZ => component == 2,
        Quantity::Lift | Quantity::Torque(_) => false,
    };
    // however small it is, and whether the air or the velocity's error makes it
    let wandering = redness.iter().filter(|red| red.statistic > RED_STATISTIC && along(red.of));
    wandering.map(|red| red.correlation_s).fold(0.0, f64::max)
}

/// When the vehicle was where.
pub(super) struct Visits<'a> {
    /// m, of each row
    pub(super) at_m: &'a [f64],
    /// m
    pub(super) range_m: (f64, f64),
    /// s, correlation time of what wanders by itself
    pub(super) wanders_s: f64,
}

/// Whether the columns explain something in most parts of the flight, no part gives half of it, and other visits to the same places
/// predict it.
pub(super) fn all_along(after: &Fitted, columns: &[Channels], theta: &[f64], visits: &Visits) -> bool {
    let Some((_, partialled)) = after.weighted.partialled(columns) else { return false };
    let left = &after.weighted.left;
    let parts: Vec<Part> =
        (0..STRETCHES).map(|stretch| Part::of(left, &partialled, (stretch, visits.at_m))).collect();
    let theta = DVector::from_column_slice(theta);
    let gains: Vec<f64> = parts.iter().map(|part| part.gain(&theta)).collect();
    let total: f64 = gains.iter().sum();
    let helped = gains.iter().filter(|gain| **gain > 0.0).count();
    let spread = helped >= LEAST_STRETCHES && gains.iter().all(|gain| *gain < 0.5 * total);
    let part_s = after.rows.len() as f64 * median_step(&after.rows.time_s) / STRETCHES as f64;
    let apart = (FORGOTTEN * visits.wanders_s / part_s, AWAY * (visits.range_m.1 - visits.range_m.0));
    spread && predicted(&parts, apart).is_some_and(|predicted| predicted > PREDICTED * total)
}

/// Energy of all parts that fits to other visits explain: without the part, its neighbours, and the parts before and after it until the
/// vehicle was `away_m` away and `apart` parts have passed. A force that wanders by itself is the same as long as the vehicle stays, and
/// only a force that belongs to the place is there again on another leg.
fn predicted(parts: &[Part], (apart, away_m): (f64, f64)) -> Option<f64> {
    let is_another = |place: usize, other: usize| {
        let (at_m, to) = (parts[place].at_m, &parts[other]);
        let away = (to.most_m - at_m).max(at_m - to.least_m) > away_m;
        away && other.abs_diff(place) as f64 > apart
    };
    let of = |(place, part): (usize, &Part)| {
        let mut from = place.saturating_sub(1);
        while from > 0 && !is_another(place, from) {
            from -= 1;
        }
        let mut to = place + 1;
        while to < parts.len() && !is_another(place, to) {
            to += 1;
        }
        let others = || parts.iter().enumerate().filter(|(other, _)| *other < from || *other > to);
        let size = part.along.len();
        let normal = others().fold(DMatrix::zeros(size, size), |sum, (_, of)| sum + &of.normal);
        let along = others().fold(DVector::zeros(size), |sum, (_, of)| sum + &of.along);
        // a place that no other visit has seen is predicted as nought
        let ridge = UNSEEN * parts.iter().map(|part| part.normal.trace()).sum::<f64>() / size as f64;
        let theta = (normal + DMatrix::identity(size, size) * ridge).cholesky()?.solve(&along);
        Some(part.gain(&theta))
    };
    parts.iter().enumerate().map(of).sum()
}

/// Products of the columns and of what is left in one part of the flight.
struct Part {
    normal: DMatrix<f64>,
    along: DVector<f64>,
    /// m, positions: mean, least and greatest
    at_m: f64,
    least_m: f64,
    most_m: f64,
}

impl Part {
    fn of(left: &DVector<f64>, partialled: &DMatrix<f64>, (stretch, positions_m): (usize, &[f64])) -> Self {
        let rows = left.len() / CHANNELS;
        let (from, to) = (rows * stretch / STRETCHES, rows * (stretch + 1) / STRETCHES);
        let size = partialled.ncols();
        let own = &positions_m[from..to];
        let mut part = Self {
            normal: DMatrix::zeros(size, size),
            along: DVector::zeros(size),
            at_m: own.iter().sum::<f64>() / own.len().max(1) as f64,
            least_m: own.iter().copied().fold(f64::INFINITY, f64::min),
            most_m: own.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        };
        for channel in 0..CHANNELS {
            let columns = partialled.rows(channel * rows + from, to - from);
            part.normal += columns.tr_mul(&columns);
            part.along += columns.tr_mul(&left.rows(channel * rows + from, to - from));
        }
        part
    }

    /// By how much these coefficients lower the energy that is left.
    fn gain(&self, theta: &DVector<f64>) -> f64 {
        2.0 * theta.dot(&self.along) - theta.dot(&(&self.normal * theta))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    const ROWS: usize = 240;

    /// Share of what a bump at 1 m explains along a flight that other visits predict, of a force (N) by row.
    fn share_predicted(apart: f64, at_m: impl Fn(f64) -> f64, force_n: impl Fn(f64) -> f64) -> f64 {
        let of_rows = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..ROWS).map(|row| of(row as f64 / ROWS as f64)).collect()
        };
        let positions_m = of_rows(&at_m);
        let mut left = DVector::zeros(CHANNELS * ROWS);
        left.rows_mut(0, ROWS).copy_from_slice(&of_rows(&force_n));
        let mut columns = DMatrix::zeros(CHANNELS * ROWS, 2);
        for (row, at) in positions_m.iter().enumerate() {
            columns[(row, 0)] = (-0.5 * ((at - 1.0) / 0.4).powi(2)).exp();
            columns[(row, 1)] = (-0.5 * ((at + 1.0) / 0.4).powi(2)).exp();
        }
        let parts: Vec<Part> =
            (0..STRETCHES).map(|stretch| Part::of(&left, &columns, (stretch, &positions_m))).collect();
        let normal = parts.iter().fold(DMatrix::zeros(2, 2), |sum, part| sum + &part.normal);
        let along = parts.iter().fold(DVector::zeros(2), |sum, part| sum + &part.along);
        let theta = normal.cholesky().unwrap().solve(&along);
        let total: f64 = parts.iter().map(|part| part.gain(&theta)).sum();
        predicted(&parts, (apart, AWAY * 3.0)).unwrap() / total
    }

    #[test]
    fn only_what_is_there_again_on_another_leg_belongs_to_the_place() {
        let bump = |at: f64| (-0.5 * ((at - 1.0) / 0.4_f64).powi(2)).exp();
        // three legs out and back
        let legs = |share: f64| 1.5 * (3.0 * std::f64::consts::TAU * share).sin();
        assert!(share_predicted(0.0, legs, |share| bump(legs(share))) > 0.9);
        // one way, with a stay at each end: what blew in the second half is no place
        let once = |share: f64| if share < 0.5 { -1.0 } else { 1.0 };
        let wind = |share: f64| if share < 0.5 { 0.0 } else { 1.0 };
        assert!(share_predicted(0.0, once, wind) < 0.5 * PREDICTED);
        // the same wind over the legs
        assert!(share_predicted(0.0, legs, wind) < PREDICTED);
        // what is known to wander for half a flight cannot be told from a place by three legs
        assert!(share_predicted(6.0, legs, |share| bump(legs(share))) < 0.9);
        // parts of the flight that last as long as a leg
        for count in [12.0, 15.0] {
            let legs = |share: f64| 1.5 * (count * std::f64::consts::TAU * share).sin();
            assert!(share_predicted(0.0, legs, |share| bump(legs(share))) > 0.9);
        }
    }
}
