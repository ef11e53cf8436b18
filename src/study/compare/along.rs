//! Where along a row of flights the vehicle changed, beside a load that one of them had.

use super::judge::{Judge, beyond, flight_groups};
use super::result::{Changed, Compared};
use crate::change::{Groups, NAMED_SIGMAS, Step, What};
use std::cmp::Reverse;

/// Most flights of a row in which each is held against every earlier one.
const MOST_ALONE: usize = 60;

impl Judge<'_> {
    /// Judges each step by the flights that it parts. Where these differ by no more than a load moves the balance, there is no step. What
    /// comes later is held against the most flights since the last step, and not against those which had such a load.
    pub(super) fn beside_loads(
        &self,
        found: Vec<Step<Compared>>,
        order: &[usize],
        least_sigmas: f64,
    ) -> Vec<Step<Compared>> {
        let borders: Vec<usize> =
            std::iter::once(0).chain(found.iter().map(|step| step.from)).chain([order.len()]).collect();
        let part = |place: usize| borders[place]..borders[place + 1];
        let is_step = |of: &Compared| of.strongest() > 0.0 && of.strongest() >= least_sigmas;
        let (mut out, mut alike): (Vec<Step<Compared>>, Vec<usize>) = (Vec::new(), vec![0]);
        for (place, step) in found.into_iter().enumerate() {
            let against = |earlier: usize| {
                let groups = Groups { before: part(earlier).collect(), after: part(place + 1).collect() };
                let change = self.compared(&flight_groups(&groups, order));
                Step { from: step.from, groups, change, as_before: Vec::new() }
            };
            let own = against(place);
            if own.change.changes.is_empty() && own.change.balance.by_a_load {
                alike.push(place + 1);
                continue;
            }
            let reference = alike.iter().copied().max_by_key(|&other| (part(other).len(), Reverse(other)));
            let wide = reference.filter(|&reference| reference != place).map(against);
            match wide {
                // the load is gone again
                Some(wide) if wide.change.changes.is_empty() => {
                    alike.push(place + 1);
                    continue;
                }
                Some(mut wide) if is_step(&wide.change) => {
                    add_rivals(&mut wide.change, &own.change);
                    out.push(wide);
                }
                _ if is_step(&own.change) && own.change.has_name() => out.push(own),
                _ => out.push(step),
            }
            alike = vec![place + 1];
        }
        out
    }

    /// The steps of a row with those that flights show alone. Where only the flight alone has a name for what changed, the step is its. A step
    /// of the row beside one of a flight alone is judged again: what that one accounts for is no step.
    pub(super) fn with_alone(
        &self,
        mut found: Vec<Step<Compared>>,
        alone: Vec<Step<Compared>>,
        order: &[usize],
    ) -> Vec<Step<Compared>> {
        let mut added: Vec<usize> = Vec::new();
        for of_flight in alone {
            match found.iter_mut().find(|step| step.from == of_flight.from) {
                Some(step) if !step.change.has_name() && of_flight.change.has_name() => *step = of_flight,
                Some(_) => {}
                None => {
                    added.push(of_flight.from);
                    found.push(of_flight);
                }
            }
        }
        found.sort_by_key(|step| step.from);
        let borders: Vec<usize> =
            std::iter::once(0).chain(found.iter().map(|step| step.from)).chain([order.len()]).collect();
        let part = |place: usize| (borders[place]..borders[place + 1]).collect();
        let judged = |(place, step): (usize, Step<Compared>)| {
            let is_new = |border: usize| added.contains(&border);
            if is_new(step.from) || !(is_new(borders[place]) || is_new(borders[place + 2])) {
                return Some(step);
            }
            let groups = Groups { before: part(place), after: part(place + 1) };
            let change = self.compared(&flight_groups(&groups, order));
            (!change.changes.is_empty()).then_some(Step { groups, change, ..step })
        };
        found.into_iter().enumerate().filter_map(judged).collect()
    }

    /// Flights that differ from every earlier one, each alone against each: what a pair of flights shows, a row of them does not lose.
    /// There are as many places for it as pairs, so it has to be more certain. The change is that against the flight which
    /// differs the least. Once the vehicle changed, a flight that differs from the one before it, and not from all, went back.
    pub(super) fn each_alone(&self, order: &[usize], least_sigmas: f64) -> Vec<Step<Compared>> {
        let count = order.len();
        if !(3..=MOST_ALONE).contains(&count) {
            return Vec::new();
        }
        let least = least_sigmas.max(NAMED_SIGMAS).hypot(beyond(count * (count - 1) / 2));
        let against = |later: usize, earlier: usize| {
            let groups = Groups { before: vec![earlier], after: vec![later] };
            let change = self.compared(&flight_groups(&groups, order));
            let step = Step { from: later, groups, change, as_before: Vec::new() };
            (step.change.beside_a_load() >= least).then_some(step)
        };
        let new = |later: usize| {
            let each = (0..later).map(|earlier| against(later, earlier)).collect::<Option<Vec<_>>>()?;
            // that with a name, if there is one
            let weaker = |a: &&Step<Compared>, b: &&Step<Compared>| {
                let key = |step: &Step<Compared>| (!step.change.has_name(), step.change.strongest());
                let ((one, a), (other, b)) = (key(a), key(b));
                one.cmp(&other).then(a.total_cmp(&b))
            };
            let least = each.iter().min_by(weaker)?;
            let mut step = least.clone();
            each.iter().for_each(|other| add_rivals(&mut step.change, &other.change));
            Some(step)
        };
        let mut found: Vec<Step<Compared>> = Vec::new();
        for later in 1..count {
            let back = || against(later, later - 1).filter(|_| !found.is_empty());
            let step = new(later).or_else(back);
            found.extend(step);
        }
        found
    }
}

/// What other flights before say of the balance is another explanation of the same.
fn add_rivals(change: &mut Compared, other: &Compared) {
    let what = |changed: Changed| match changed {
        Changed::Rotor(rotor) => Some(What::Rotor(rotor)),
        Changed::CentreOfMass(_) => Some(What::CentreOfMass),
        Changed::YawTorque => Some(What::YawTorque),
        Changed::Balance | Changed::Parameter(_) => None,
    };
    let of_balance = |changed: Changed| !matches!(changed, Changed::Parameter(_));
    let others = other.changes.iter().filter(|change| of_balance(change.what));
    let said: Vec<What> =
        others.flat_map(|change| what(change.what).into_iter().chain(change.rivals.clone())).collect();
    for own in change.changes.iter_mut().filter(|change| of_balance(change.what)) {
        for rival in &said {
            if what(own.what) != Some(*rival) && !own.rivals.contains(rival) {
                own.rivals.push(*rival);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::by_motion::WeakAlone;
    use super::*;
    use crate::config::load_vehicle;
    use crate::trim::{Balance, FlightBalance, mean_arm_m};
    use crate::vehicle::Vehicle;
    use nalgebra::{DMatrix, Vector3};
    use std::path::Path;

    fn vehicle() -> Vehicle {
        load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap()
    }

    /// Share of the commanded thrust of a rotor of four that gives 0.93 of its thrust.
    const WEAK_SHARE: f64 = 0.25 / 0.93 / (0.75 + 0.25 / 0.93);

    /// Where that rotor pulls the balance to.
    fn weak(vehicle: &Vehicle, rotor: usize) -> Vector3<f64> {
        let of = &vehicle.rotors[rotor];
        let at = (of.position_m - vehicle.body.center_of_mass_m) / mean_arm_m(vehicle);
        (WEAK_SHARE - 0.25) / 0.75 * Vector3::new(at.x, at.y, of.spin.yaw_sign())
    }

    /// Flights whose balance is known to 0.0015 and wanders by as much.
    fn balance(leans: &[Vector3<f64>]) -> Balance {
        let of = |lean: &Vector3<f64>| FlightBalance {
            lean: [lean.x, lean.y, lean.z],
            wander: [0.0015, 0.0015, 0.002],
            scatter: [0.0025; 3],
            legs: 20,
            felt: [0.0; 2],
            shares: vec![0.25; 4],
            lift: None,
            voltage_v: None,
        };
        let covariance = DMatrix::identity(leans.len(), leans.len()) * 0.0015 * 0.0015;
        Balance {
            flights: leans.iter().map(of).collect(),
            covariance: std::array::from_fn(|_| covariance.clone()),
            air_lever: [(0.0, 1.0); 2],
        }
    }

    /// From which flights on what changed, and what else it may be.
    fn history(leans: &[Vector3<f64>]) -> Vec<(usize, Changed, Vec<What>)> {
        let (vehicle, balance) = (vehicle(), balance(leans));
        let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
        let order: Vec<usize> = (0..leans.len()).collect();
        let steps = judge.history(&order, 0.0);
        let each = |step: &Step<Compared>| {
            let of = |change: &super::super::Change| (step.from, change.what, change.rivals.clone());
            step.change.changes.iter().map(of).collect::<Vec<_>>()
        };
        steps.iter().flat_map(each).collect()
    }

    #[test]
    fn a_weak_rotor_is_found_behind_a_flight_with_another_load() {
        let (none, load) = (Vector3::zeros(), Vector3::new(0.045, 0.03, 0.0));
        let weak = weak(&vehicle(), 2);
        for before in [&[none, load][..], &[none, none, none, load]] {
            let found = history(&[before, &[weak]].concat());
            assert!(
                matches!(found.as_slice(), [(from, Changed::Rotor(2), _)] if *from == before.len()),
                "{found:?}"
            );
        }
        // the load alone is no change
        assert!(history(&[none, load, none]).is_empty());
        assert!(history(&[none, none, none]).is_empty());
    }

    #[test]
    fn an_unchanged_history_says_what_a_border_in_its_middle_would_have_shown() {
        let (vehicle, balance) = (vehicle(), balance(&[Vector3::zeros(); 5]));
        let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
        let order: Vec<usize> = (0..5).collect();
        let least = judge.least_in_the_middle(&order);
        let between = judge.compared(&Groups::split(5, 2)).least;
        assert!(!least.is_empty() && least.len() == between.len());
        for (along, between) in least.iter().zip(&between) {
            // of four borders one is reached by chance more often than one of one
            assert!(
                along.what == between.what && along.size > between.size && along.size < 1.2 * between.size
            );
        }
        // a rotor that lost a little more is named, and one that lost less is not
        for (factor, is_found) in [(1.1, true), (0.9, false)] {
            let lost = factor * least[0].size / 4.0;
            let of = &vehicle.rotors[0];
            let at = (of.position_m - vehicle.body.center_of_mass_m) / mean_arm_m(&vehicle);
            let lean = lost * Vector3::new(at.x, at.y, of.spin.yaw_sign());
            let none = Vector3::zeros();
            assert_eq!(!history(&[none, none, lean, lean, lean]).is_empty(), is_found, "{lost}");
        }
    }

    #[test]
    fn the_standard_deviations_of_a_named_rotor_are_its_loss_over_its_error() {
        let vehicle = vehicle();
        let mut balance = balance(&[Vector3::zeros(), weak(&vehicle, 2)]);
        balance.flights[1].shares = vec![(1.0 - WEAK_SHARE) / 3.0; 4];
        balance.flights[1].shares[2] = WEAK_SHARE;
        let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
        let compared = judge.compared(&Groups::split(2, 1));
        let [change] = compared.changes.as_slice() else { panic!("{compared:?}") };
        let moved = change.moved.unwrap();
        assert!(change.what == Changed::Rotor(2) && (moved.after.0 - 0.93).abs() < 1e-9, "{compared:?}");
        assert!((change.sigmas - moved.sigmas().abs()).abs() < 1e-9, "{compared:?}");
        // the same balance is further than that from what an unchanged vehicle would show
        assert!(change.sigmas < compared.balance.strength.sqrt(), "{compared:?}");
        // the way back is the same change
        let back = judge.compared(&Groups { before: vec![1], after: vec![0] });
        let [of_back] = back.changes.as_slice() else { panic!("{back:?}") };
        assert!(of_back.what == change.what && (of_back.sigmas - change.sigmas).abs() < 1e-9, "{back:?}");
        assert!((of_back.moved.unwrap().after.0 * moved.after.0 - 1.0).abs() < 1e-9, "{back:?}");
    }

    #[test]
    fn a_return_is_named_where_certainly_less_than_half_of_the_step_is_left() {
        let (vehicle, none) = (vehicle(), Vector3::zeros());
        let weak = weak(&vehicle, 2);
        let row = |last: Vector3<f64>| balance(&[none, none, weak, last]);
        let returned = row(none);
        let judge = Judge { vehicle: &vehicle, balance: &returned, tracks: &[], alone: &[], is_known: true };
        let steps = judge.history(&[0, 1, 2, 3], 0.0);
        let places: Vec<(usize, Vec<usize>)> =
            steps.into_iter().map(|step| (step.from, step.as_before)).collect();
        assert_eq!(places, [(2, vec![]), (3, vec![0, 1])]);
        let is_back = |share: f64| {
            let balance = row(share * weak);
            let judge =
                Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
            let step = judge.compared(&Groups { before: vec![0, 1], after: vec![2] });
            judge.is_back(&Groups { before: vec![0, 1], after: vec![3] }, &step)
        };
        assert!(is_back(0.1) && is_back(-0.1) && !is_back(0.4) && !is_back(-0.4) && !is_back(1.0));
    }

    #[test]
    fn what_is_left_of_a_step_may_be_a_load_that_sits_elsewhere_as_in_the_step() {
        let (vehicle, none) = (vehicle(), Vector3::zeros());
        let is_back = |left: f64| {
            let along_x = |by: f64| Vector3::new(by, 0.0, 0.0);
            let balance = balance(&[none, none, along_x(0.12), along_x(left)]);
            let judge =
                Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
            let step = judge.compared(&Groups { before: vec![0, 1], after: vec![2] });
            assert!(step.certain().any(|change| change.what == Changed::CentreOfMass(0)), "{step:?}");
            judge.is_back(&Groups { before: vec![0, 1], after: vec![3] }, &step)
        };
        // with 0.014 of an arm for the load of both sides, 0.045 of 0.12 are not certainly less than half
        assert!(is_back(0.0) && is_back(0.02) && !is_back(0.045));
    }

    #[test]
    fn the_error_of_a_centre_of_mass_allows_for_a_load_in_each_flight() {
        let (vehicle, moved) = (vehicle(), Vector3::new(0.12, 0.0, 0.0));
        let balance = balance(&[Vector3::zeros(), moved]);
        let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
        let compared = judge.compared(&Groups::split(2, 1));
        let [change] = compared.changes.as_slice() else { panic!("{compared:?}") };
        let (by, std) = change.moved.unwrap().by;
        let arm_m = mean_arm_m(&vehicle);
        assert!(change.what == Changed::CentreOfMass(0) && (by - 0.12 * arm_m).abs() < 1e-9, "{compared:?}");
        // 1 % of an arm on each side, beside the error of the balance
        let own = arm_m * compared.balance.moved[0].by.1;
        assert!((std - own.hypot(2.0_f64.sqrt() * 0.01 * arm_m)).abs() < 1e-9, "{std} {own}");
        assert!((change.sigmas - by / std).abs() < 1e-9 && compared.strongest() > change.sigmas);
    }

    #[test]
    fn a_load_that_sits_elsewhere_leaves_no_rotor_among_what_would_have_been_named() {
        let (vehicle, load) = (vehicle(), Vector3::new(0.03, 0.02, 0.0));
        let is_moved = |leans: &[Vector3<f64>], groups: Option<&Groups>| {
            let balance = balance(leans);
            let judge =
                Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
            judge.moved_without_name(groups)
        };
        let none = Vector3::zeros();
        assert!(is_moved(&[none, load], Some(&Groups::split(2, 1))));
        assert!(is_moved(&[none, load], None) && !is_moved(&[none, none, none], None));
        // a rotor with a name is one
        assert!(!is_moved(&[none, weak(&vehicle, 2)], Some(&Groups::split(2, 1))));
    }

    #[test]
    fn a_rotor_and_a_centre_of_mass_that_changed_together_get_no_single_name() {
        let vehicle = vehicle();
        let together = weak(&vehicle, 2) + Vector3::new(-0.09, -0.02, 0.0);
        let balance = balance(&[Vector3::zeros(), together]);
        let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone: &[], is_known: true };
        let compared = judge.compared(&Groups::split(2, 1));
        assert_eq!(compared.changes.iter().map(|change| change.what).collect::<Vec<_>>(), [Changed::Balance]);
    }

    #[test]
    fn a_rotor_that_the_motion_names_accounts_for_the_balance_that_it_moves_and_for_no_more() {
        let vehicle = vehicle();
        let alone = [None, Some((2, (0.93, 0.002)))].map(|rotor| Some(WeakAlone { rotor, limit: 0.008 }));
        let changed = |more: Vector3<f64>, alone: &[Option<WeakAlone>]| -> Vec<Changed> {
            let balance = balance(&[Vector3::zeros(), weak(&vehicle, 2) + more]);
            let judge = Judge { vehicle: &vehicle, balance: &balance, tracks: &[], alone, is_known: true };
            let compared = judge.compared(&Groups::split(2, 1));
            assert!(
                alone.is_empty()
                    || compared.changes.iter().all(|change| !change.rivals.contains(&What::Rotor(2)))
            );
            compared.changes.iter().map(|change| change.what).collect()
        };
        // a load that sits elsewhere
        let load = Vector3::new(0.03, 0.0, 0.0);
        assert_eq!(changed(load, &[]), [Changed::Balance]);
        assert_eq!(changed(load, &alone), [Changed::Rotor(2)]);
        // a centre of mass that moved as well
        let mut both = changed(Vector3::new(-0.09, -0.02, 0.0), &alone);
        both.sort_by_key(|what| *what == Changed::Balance);
        assert_eq!(both, [Changed::Rotor(2), Changed::Balance]);
    }
}
