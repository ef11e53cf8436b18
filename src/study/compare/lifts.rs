//! Full thrust over weight that says that flights may be those of two vehicles.

use super::judge::{Judge, beyond, is_of_vehicle};
use super::result::{LiftsApart, LiftsOf};
use crate::change::{Groups, UNDECIDED, judge_parameter};
use crate::study::Track;
use crate::trim::FlightBalance;
use std::ops::Range;

/// Full thrust over weight of one group over that of the other from which on this may be two vehicles. A battery takes a tenth of it, a load
/// that leaves room to fly a fifth. Set by judgement.
const OTHER_LIFT: f64 = 1.3;

/// A flight of a row whose full thrust over weight is not that of most others, and whether a parameter moved as well.
type Odd = (usize, bool);

impl Judge<'_> {
    /// Full thrust over weight where it differs by more than one vehicle's does, also for the voltage where all flights have one, and no
    /// parameter tells that it is one vehicle: none is compared, or one of them moved as well. Of the groups; without groups of the
    /// flights of a row that differ from most others, and without such flights at the place of the row where it differs the most.
    #[must_use]
    pub fn lifts_apart(&self, groups: Option<&Groups>) -> Option<LiftsApart> {
        if let Some(groups) = groups {
            return self.apart(groups, LiftsOf::Groups, UNDECIDED);
        }
        let count = self.balance.flights.len();
        let at = |from: usize| self.apart(&Groups::split(count, from), LiftsOf::From(from), UNDECIDED);
        let widest = || (1..count).filter_map(at).max_by(|a, b| a.ratio().total_cmp(&b.ratio()));
        let odd = self.odd();
        if odd.is_empty() {
            return widest();
        }
        // those at an end of the row are told by its place
        let ends = [(0..odd.len(), odd.len()), (count - odd.len()..count, count - odd.len())];
        let are = |places: &Range<usize>| odd.iter().map(|(flight, _)| *flight).eq(places.clone());
        let border = ends.into_iter().find(|(places, _)| are(places)).and_then(|(_, from)| at(from));
        border.or_else(|| self.odd_apart(&odd)).or_else(widest)
    }

    /// Full thrust over weight of two groups, if it differs and no parameter tells that it is one vehicle. Where one moved by `least_sigmas`
    /// standard deviations, they tell nothing.
    fn apart(&self, groups: &Groups, of: LiftsOf, least_sigmas: f64) -> Option<LiftsApart> {
        let (before, after) = self.differing_lifts(groups)?;
        let for_voltage = self.lifts_for_voltage(groups).is_none_or(are_apart);
        let tells = |track: &Track| {
            is_of_vehicle(track) && judge_parameter(&track.values, groups, &track.spread).is_some()
        };
        let moved = self.compared(groups).moved_by_motion(least_sigmas) > 0;
        let is_told = !for_voltage || !moved && self.tracks.iter().any(tells);
        (!is_told).then_some(LiftsApart { before, after, of, moved })
    }

    /// The flights of a row that may be of another vehicle than most others, in their order: each is held against those of the others that
    /// give less, or more, by as much as one vehicle's flights do not differ, where these are most of them. Of two vehicles with as
    /// many flights each, the first flight is of the one that is meant.
    fn odd(&self) -> Vec<Odd> {
        let known = self.known_lifts();
        // a parameter may have moved by chance in each of them
        let least = UNDECIDED.hypot(beyond(known.len()));
        let of = |(flight, lift): &(usize, f64)| {
            let side = |is_less: bool| -> Vec<usize> {
                let is_there =
                    |(_, other): &&(usize, f64)| are_apart((*other, *lift)) && (other < lift) == is_less;
                known.iter().filter(is_there).map(|(place, _)| *place).collect()
            };
            let before = [side(true), side(false)].into_iter().find(|side| 2 * side.len() >= known.len())?;
            let most = 2 * before.len() > known.len();
            let groups = Groups { before, after: vec![*flight] };
            Some(((*flight, self.apart(&groups, LiftsOf::Groups, least)?.moved), most))
        };
        let mut odd: Vec<(Odd, bool)> = known.iter().filter_map(of).collect();
        if odd.len() == known.len() {
            let is_other = |flight: usize| {
                let lift = |place: usize| known.iter().find(|(of, _)| *of == place).map(|(_, lift)| *lift);
                known.first().map(|(_, meant)| *meant).zip(lift(flight)).is_some_and(are_apart)
            };
            odd.retain(|((flight, _), _)| is_other(*flight));
        } else {
            // half of them are not most
            odd.retain(|(_, most)| *most);
        }
        odd.into_iter().map(|(of, _)| of).collect()
    }

    /// What is told of odd flights. `None` where one of them is not far from the mean of the others: a flight of two vehicles between which the
    /// others lie.
    fn odd_apart(&self, odd: &[Odd]) -> Option<LiftsApart> {
        let is_odd = |place: usize| odd.iter().any(|(flight, _)| *flight == place);
        let (of_odd, of_others): (Vec<_>, Vec<_>) =
            self.known_lifts().into_iter().partition(|(flight, _)| is_odd(*flight));
        let before = of_others.iter().map(|(_, lift)| lift).sum::<f64>() / of_others.len() as f64;
        if of_odd.iter().any(|(_, after)| !are_apart((before, *after))) {
            return None;
        }
        let apart = of_odd.iter().map(|(_, after)| LiftsApart {
            before,
            after: *after,
            of: LiftsOf::Odd(odd.iter().map(|(flight, _)| *flight).collect()),
            moved: odd.iter().any(|(_, moved)| *moved),
        });
        apart.max_by(|a, b| a.ratio().total_cmp(&b.ratio()))
    }

    /// Full thrust over weight of the flights that have it, with their places.
    fn known_lifts(&self) -> Vec<(usize, f64)> {
        let of = |(place, flight): (usize, &FlightBalance)| Some((place, flight.lift?.0));
        self.balance.flights.iter().enumerate().filter_map(of).collect()
    }

    /// Mean full thrust over weight of both groups, where all flights have it and it differs by more than that of one vehicle.
    pub(super) fn differing_lifts(&self, groups: &Groups) -> Option<(f64, f64)> {
        self.means(groups, |flight| Some(flight.lift?.0)).filter(|lifts| are_apart(*lifts))
    }

    /// Mean full thrust over weight of both groups over the square of the voltage, with which a battery's goes, where all flights have both.
    fn lifts_for_voltage(&self, groups: &Groups) -> Option<(f64, f64)> {
        self.means(groups, |flight| Some(flight.lift?.0 / flight.voltage_v?.powi(2)))
    }

    fn means(&self, groups: &Groups, of: impl Fn(&FlightBalance) -> Option<f64>) -> Option<(f64, f64)> {
        let mean = |group: &[usize]| {
            let each = group.iter().map(|&flight| of(&self.balance.flights[flight]));
            Some(each.sum::<Option<f64>>()? / group.len() as f64)
        };
        mean(&groups.before).zip(mean(&groups.after))
    }
}

/// Full thrust over weight of two groups, or two masses, that differ by more than those of one vehicle.
pub(in crate::study) fn are_apart((before, after): (f64, f64)) -> bool {
    before.max(after) > OTHER_LIFT * before.min(after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::load_vehicle;
    use crate::diagnose::Owner;
    use crate::trim::Balance;
    use nalgebra::DMatrix;
    use std::path::Path;

    /// Flights of the same balance, each with this full thrust over weight and voltage.
    fn balance(each: &[(Option<f64>, Option<f64>)]) -> Balance {
        let of = |(lift, voltage_v): &(Option<f64>, Option<f64>)| FlightBalance {
            lean: [0.0; 3],
            wander: [0.0015; 3],
            scatter: [0.0025; 3],
            legs: 20,
            felt: [0.0; 2],
            shares: vec![0.25; 4],
            lift: lift.map(|lift| (lift, 0.01)),
            voltage_v: *voltage_v,
        };
        let covariance = DMatrix::identity(each.len(), each.len()) * 0.0015 * 0.0015;
        Balance {
            flights: each.iter().map(of).collect(),
            covariance: std::array::from_fn(|_| covariance.clone()),
            air_lever: [(0.0, 1.0); 2],
        }
    }

    fn apart(balance: &Balance, tracks: &[Track], groups: Option<&Groups>) -> Option<LiftsApart> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
        let vehicle = load_vehicle(&path).unwrap();
        Judge { vehicle: &vehicle, balance, tracks, alone: &[], is_known: false }.lifts_apart(groups)
    }

    /// What a row of flights says, each with this full thrust over weight; 0: it states none.
    fn along(lifts: &[f64]) -> Option<LiftsOf> {
        let each: Vec<_> = lifts.iter().map(|lift| (Some(*lift).filter(|lift| *lift > 0.0), None)).collect();
        apart(&balance(&each), &[], None).map(|apart| apart.of)
    }

    #[test]
    fn another_lift_is_a_doubt_where_no_voltage_and_no_parameter_accounts_for_it() {
        let groups = Groups::split(4, 2);
        let known = |lifts: [f64; 4]| lifts.map(|lift| (Some(lift), None));
        assert_eq!(apart(&balance(&known([2.4, 2.5, 2.4, 3.5])), &[], Some(&groups)), None);
        let between = apart(&balance(&known([2.4, 2.5, 3.5, 3.5])), &[], Some(&groups)).unwrap();
        assert!(between.of == LiftsOf::Groups && between.after == 3.5, "{between:?}");
        // a drained battery
        let mut drained = known([2.4, 2.5, 3.5, 3.5]);
        for (flight, volts) in drained.iter_mut().zip([10.2, 10.4, 12.4, 12.6]) {
            flight.1 = Some(volts);
        }
        assert_eq!(apart(&balance(&drained), &[], Some(&groups)), None);
        assert_eq!(apart(&balance(&drained), &[], None), None);
    }

    #[test]
    fn each_flight_of_a_row_is_held_against_the_others() {
        assert_eq!(along(&[2.4, 2.5, 2.4, 2.5]), None);
        assert_eq!(along(&[2.4, 2.5, 2.4, 3.5]), Some(LiftsOf::From(3)));
        assert_eq!(along(&[3.5, 2.4, 2.5]), Some(LiftsOf::From(1)));
        assert_eq!(along(&[2.4, 1.2, 2.4]), Some(LiftsOf::Odd(vec![1])));
        assert_eq!(along(&[2.4, 2.5, 3.5, 2.4, 2.4, 2.5, 2.4, 2.4]), Some(LiftsOf::Odd(vec![2])));
        // two that are alike, two on both sides, and as many as of the first vehicle
        assert_eq!(along(&[2.4, 3.5, 2.5, 3.5, 2.4]), Some(LiftsOf::Odd(vec![1, 3])));
        assert_eq!(along(&[2.4, 3.5, 2.5, 1.2, 2.4]), Some(LiftsOf::Odd(vec![1, 3])));
        assert_eq!(along(&[2.4, 3.5, 2.4, 3.5]), Some(LiftsOf::Odd(vec![1, 3])));
        // one that states none says nothing
        assert_eq!(along(&[2.4, 0.0, 3.5, 2.4]), Some(LiftsOf::Odd(vec![2])));
        assert_eq!(along(&[2.4, 0.0, 2.5, 2.4]), None);
        // no flight is apart from most others, the parts are
        assert_eq!(along(&[2.0, 2.3, 2.3, 2.3, 2.9, 2.9, 2.9]), Some(LiftsOf::From(4)));
        let said =
            apart(&balance(&[2.4, 3.5, 2.5, 1.2, 2.6].map(|lift| (Some(lift), None))), &[], None).unwrap();
        assert!((said.before - 2.5).abs() < 1e-12 && said.after == 1.2 && !said.moved, "{said:?}");
    }

    #[test]
    fn a_parameter_that_stayed_tells_a_payload_from_another_vehicle_and_one_that_moved_does_not() {
        let balance = balance(&[2.4, 1.2, 2.4].map(|lift| (Some(lift), None)));
        let latency = |middle: f64| {
            let values = [0.02, middle, 0.02].map(|value| Some((value, 0.001))).to_vec();
            Track::stored(("latency", "s"), (Owner::Vehicle, None), values, vec![0.0; 3]).unwrap()
        };
        assert_eq!(apart(&balance, &[latency(0.02)], None), None);
        let said = apart(&balance, &[latency(0.04)], None).unwrap();
        assert!(said.moved && said.of == LiftsOf::Odd(vec![1]), "{said:?}");
    }
}
