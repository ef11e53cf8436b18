//! Thrust for a command over the weight, and where it moved: the scale of all forces and moments of inertia.

use crate::change::Groups;
use crate::trim::{Balance, FlightBalance};
use crate::vehicle::Anchor;

/// Full thrust over weight moved from so many standard errors on.
const MOVED: f64 = 3.0;
/// The same as a share of it: less is the scatter of the law of thrust.
const LEAST: f64 = 0.01;
/// A move from which on it is told, as a share. With less, each battery would be told.
const TOLD: f64 = 0.05;

/// Full thrust over weight that moved: a payload, another battery or air density, which are each flight's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleMoved {
    /// full thrust over weight before, mean of the flights, with its standard error
    pub before: (f64, f64),
    /// the same after
    pub after: (f64, f64),
    /// places of the flights that it is of, where no groups were given
    pub flights: Option<[usize; 2]>,
}

impl ScaleMoved {
    /// Between two groups; `None` where it is not known in all of their flights, or did not move.
    pub(super) fn between(balance: &Balance, groups: &Groups) -> Option<Self> {
        let mean = |group: &[usize]| {
            let each: Option<Vec<(f64, f64)>> = group.iter().map(|&flight| lift(balance, flight)).collect();
            mean(&each?)
        };
        Self { before: mean(&groups.before)?, after: mean(&groups.after)?, flights: None }.if_moved()
    }

    /// Of the flights of a row between which it differs the most, the earlier one first; `None` where it did not move.
    pub(super) fn along(balance: &Balance) -> Option<Self> {
        let lifts = (0..balance.flights.len()).filter_map(|flight| Some((flight, lift(balance, flight)?)));
        let lifts: Vec<(usize, (f64, f64))> = lifts.collect();
        let by_size = |a: &&(usize, (f64, f64)), b: &&(usize, (f64, f64))| a.1.0.total_cmp(&b.1.0);
        let mut ends = [*lifts.iter().min_by(by_size)?, *lifts.iter().max_by(by_size)?];
        ends.sort_by_key(|(flight, _)| *flight);
        let [(first, before), (last, after)] = ends;
        Self { before, after, flights: Some([first, last]) }.if_moved()
    }

    fn if_moved(self) -> Option<Self> {
        let (ratio, std) = self.ratio();
        let by = (ratio - 1.0).abs();
        (by >= LEAST && by >= MOVED * std).then_some(self)
    }

    /// It moved by enough to be told.
    pub(super) fn is_told(&self) -> bool {
        (self.ratio().0 - 1.0).abs() >= TOLD
    }

    /// Before over after, with its standard error.
    fn ratio(self) -> (f64, f64) {
        let ratio = self.before.0 / self.after.0;
        (ratio, ratio * (self.before.1 / self.before.0).hypot(self.after.1 / self.after.0))
    }

    /// What brings values after, as they are fitted, to the other end of the scale, with its standard error. With the mass as stated that is
    /// the thrust for a command of before: the mass after is larger by the ratio, and all with it. With the thrust as stated it is the mass of
    /// before: the thrust after is smaller by the ratio.
    pub(super) fn factor(self, anchor: Anchor) -> (f64, f64) {
        let (ratio, std) = self.ratio();
        match anchor {
            Anchor::Mass => (ratio, std),
            Anchor::Thrust => (ratio.recip(), std / (ratio * ratio)),
        }
    }
}

/// Of one flight, with its standard error.
fn lift(balance: &Balance, flight: usize) -> Option<(f64, f64)> {
    let of = |flight: &FlightBalance| flight.lift.filter(|(lift, std)| *lift > 0.0 && std.is_finite());
    balance.flights.get(flight).and_then(of)
}

/// Mean of a group's flights with its standard error: the flights' scatter is no error, because each flight has its own scale. `None` of no
/// flight.
fn mean(each: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = each.len() as f64;
    let mean = each.iter().map(|(lift, _)| lift).sum::<f64>() / count;
    let variance = each.iter().map(|(_, std)| std * std).sum::<f64>();
    (!each.is_empty()).then(|| (mean, variance.sqrt() / count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::load_vehicle;
    use crate::diagnose::Owner;
    use crate::study::{Judge, Track};
    use crate::vehicle::Vehicle;
    use nalgebra::DMatrix;
    use std::path::Path;

    fn balance(lifts: &[(f64, f64)]) -> Balance {
        let of = |lift: &(f64, f64)| FlightBalance {
            lean: [0.0; 3],
            wander: [0.0; 3],
            scatter: [0.0; 3],
            legs: 20,
            felt: [0.0; 2],
            shares: vec![0.25; 4],
            lift: Some(*lift),
            voltage_v: None,
        };
        let covariance = DMatrix::identity(lifts.len(), lifts.len());
        Balance {
            flights: lifts.iter().map(of).collect(),
            covariance: std::array::from_fn(|_| covariance.clone()),
            air_lever: [(0.0, 1.0); 2],
        }
    }

    #[test]
    fn a_payload_and_a_weak_battery_each_move_values_by_what_they_took() {
        let moved =
            ScaleMoved::between(&balance(&[(2.5, 0.025), (2.0, 0.02)]), &Groups::split(2, 1)).unwrap();
        assert!(moved.is_told());
        // weighed at 2 kg and flown at 2.5 kg: moments of inertia come out at 0.8 of theirs
        let (by_mass, std) = moved.factor(Anchor::Mass);
        assert!((by_mass - 1.25).abs() < 1e-12 && (std - 1.25 * 0.01 * 2.0_f64.sqrt()).abs() < 1e-12);
        // full thrust is 0.8 of what is stated: they come out at 1.25 of theirs
        let (by_thrust, std) = moved.factor(Anchor::Thrust);
        assert!((by_thrust - 0.8).abs() < 1e-12 && (std - 0.8 * 0.01 * 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_move_within_its_error_or_of_less_than_a_percent_is_none() {
        let between = |lifts: &[(f64, f64)], first| {
            ScaleMoved::between(&balance(lifts), &Groups::split(lifts.len(), first))
        };
        assert_eq!(between(&[(2.0, 0.001), (2.015, 0.001)], 1), None);
        assert_eq!(between(&[(2.0, 0.1), (2.3, 0.1)], 1), None);
        let moved = between(&[(2.0, 0.001), (2.05, 0.001)], 1).unwrap();
        assert!(!moved.is_told());
        // of four flights half the error
        let four = [2.0, 2.5, 2.25, 2.25].map(|lift| (lift, 0.125));
        assert_eq!(mean(&four), Some((2.25, 0.0625)));
    }

    /// Changes between three flights of each full thrust over weight, those along the six, and whether the scale is told to have moved.
    fn changes(anchor: Anchor, after: f64) -> (usize, usize, bool) {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
        let vehicle = Vehicle { anchor, ..load_vehicle(&path).unwrap() };
        let balance = balance(&[[(2.5, 0.001); 3], [(2.0, 0.001); 3]].concat());
        let values = [[Some((0.04, 4e-4)); 3], [Some((after, 4e-4)); 3]].concat();
        let izz = Track::stored(("izz", "kg m^2"), (Owner::Vehicle, None), values, vec![0.0; 6]).unwrap();
        let tracks = [izz];
        let judge =
            Judge { vehicle: &vehicle, balance: &balance, tracks: &tracks, alone: &[], is_known: true };
        let order: Vec<usize> = (0..6).collect();
        let between = judge.compared(&Groups::split(6, 3)).changes.len();
        (between, judge.history(&order, 0.0).len(), judge.scale(None).is_some())
    }

    #[test]
    fn a_moment_of_inertia_that_goes_with_the_scale_is_no_change_and_another_one_is() {
        assert_eq!(changes(Anchor::Mass, 0.032), (0, 0, true));
        assert_eq!(changes(Anchor::Thrust, 0.05), (0, 0, true));
        // half of it is none by either
        assert_eq!(changes(Anchor::Mass, 0.02), (1, 1, true));
        assert_eq!(changes(Anchor::Thrust, 0.02), (1, 1, true));
    }

    #[test]
    fn along_a_row_the_flights_that_differ_the_most_are_told_in_their_order() {
        let row = balance(&[(2.2, 0.001), (2.4, 0.001), (1.9, 0.001), (2.3, 0.001)]);
        let moved = ScaleMoved::along(&row).unwrap();
        assert_eq!((moved.flights, moved.before.0, moved.after.0), (Some([1, 2]), 2.4, 1.9));
        assert_eq!(ScaleMoved::along(&balance(&[(2.2, 0.001); 3])), None);
    }
}
