//! What changed between groups of flights whose balance and parameters are known.

use super::by_motion::{RotorMoved, WeakAlone, rotor_by_motion};
use super::result::{Change, Changed, Compared, LeastChange, UndecidedAlong};
use super::scale::ScaleMoved;
use crate::change::{
    BalanceChange, Groups, NAMED, NAMED_SIGMAS, ParameterChange, Step, UNDECIDED, What, find_returns,
    judge_at_both_scales, judge_balance, judge_parameter, left_beside_rotor, steps,
};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{Need, Owner, follows_force};
use crate::study::Track;
use crate::trim::{Balance, mean_arm_m};
use crate::vehicle::Vehicle;

/// A centre of mass that moved along one axis has moved along the other from so many standard errors on. The usual two.
const STAYED: f64 = 2.0;
/// Parameters that moved by more than chance from which on, with full thrust over weight that is apart, this is hardly one vehicle. Set by
/// judgement: one is moved by chance in one of 40 pairs of flights.
const OTHER_PARAMETERS: usize = 2;

/// What all comparisons have in common.
#[derive(Debug, Clone, Copy)]
pub struct Judge<'a> {
    /// nominal, for the places of its rotors
    pub vehicle: &'a Vehicle,
    /// of all flights, in the order in which they were given
    pub balance: &'a Balance,
    /// each parameter along the flights
    pub tracks: &'a [Track],
    /// what each flight names alone of its rotors; empty where the motion is not compared
    pub alone: &'a [Option<WeakAlone>],
    /// lengths of the vehicle are known; otherwise they are told in arms
    pub is_known: bool,
}

impl Judge<'_> {
    /// Where along the flights something changed. `order` has their places as they were flown, or shuffled; a change of fewer than
    /// `least_sigmas` standard deviations is none.
    #[must_use]
    pub fn history(&self, order: &[usize], least_sigmas: f64) -> Vec<Step<Compared>> {
        let borders = order.len().saturating_sub(1);
        let at_a_border = least_sigmas.max(at_a_border(order.len()));
        let there_and_back = least_sigmas.max(NAMED_SIGMAS).hypot(beyond(order.len() * borders / 2));
        let judged = |groups: &Groups| {
            let compared = self.compared(&flight_groups(groups, order));
            let strongest = compared.strongest();
            (strongest >= at_a_border).then_some((strongest, compared))
        };
        let found = steps(order.len(), &judged, there_and_back);
        let found = self.beside_loads(found, order, least_sigmas);
        let mut found = self.with_alone(found, self.each_alone(order, least_sigmas), order);
        find_returns(order.len(), &mut found, &|groups, step: &Compared| {
            self.is_back(&flight_groups(groups, order), step)
        });
        for step in &mut found {
            let tells = |flight| step.change.certain().any(|of| of.what.is_told_by(self.tracks, flight));
            step.as_before.retain(|place| tells(order[*place]));
        }
        found
    }

    /// The smallest changes that the first half of a row (of an odd number one flight less) and the rest of it would have shown: a change
    /// that stays from the middle on, by the standard deviations that a border of so many flights needs.
    #[must_use]
    pub fn least_in_the_middle(&self, order: &[usize]) -> Vec<LeastChange> {
        let count = order.len();
        if count < 2 {
            return Vec::new();
        }
        let wider = at_a_border(count) / NAMED_SIGMAS;
        let compared = self.compared(&flight_groups(&Groups::split(count, count / 2), order));
        compared.least.into_iter().map(|least| LeastChange { size: wider * least.size, ..least }).collect()
    }

    /// What moved by more than chance reaches at one of the borders of a row in which nothing changed, at the border where it is the
    /// strongest.
    #[must_use]
    pub fn undecided_along(&self, order: &[usize]) -> Option<UndecidedAlong> {
        let (count, least_sigmas) = (order.len(), at_a_border(order.len()));
        let least = UNDECIDED.hypot(beyond(count.saturating_sub(1)));
        let at = |from: usize| {
            let Compared { changes, undecided, .. } =
                self.compared(&flight_groups(&Groups::split(count, from), order));
            let all = changes.into_iter().chain(undecided.into_iter().map(|(change, _)| change));
            let moved: Vec<Change> =
                all.filter(|change| change.moved.is_some() && change.sigmas >= least).collect();
            (!moved.is_empty()).then_some(UndecidedAlong { from, moved, least_sigmas })
        };
        let strongest = |along: &UndecidedAlong| along.moved[0].sigmas;
        (1..count).filter_map(at).max_by(|a, b| strongest(a).total_cmp(&strongest(b)))
    }

    /// The strongest change between the flights before and those after any place of an order: standard deviations, and the flights
    /// before it; `None`: nothing changed anywhere.
    #[must_use]
    pub fn strongest(&self, order: &[usize]) -> Option<(f64, Vec<usize>)> {
        let at = |from| {
            let groups = flight_groups(&Groups::split(order.len(), from), order);
            (self.compared(&groups).strongest(), groups.before)
        };
        let all = (1..order.len()).map(at).filter(|(sigmas, _)| *sigmas > 0.0);
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// What changed between two groups of flights.
    #[must_use]
    pub fn compared(&self, groups: &Groups) -> Compared {
        let balance = judge_balance(self.balance, groups, self.vehicle);
        let mut changes = self.of_balance(&balance);
        if !changes.iter().any(|change| matches!(change.what, Changed::Rotor(_)))
            && let Some(moved) = rotor_by_motion(self.alone, groups)
        {
            self.keep_beside(&mut changes, &moved, (&balance, groups));
            changes.push(of_rotor(moved));
        }
        let mut least = self.least_of_balance(&balance);
        let mut undecided = Vec::new();
        let scale = ScaleMoved::between(self.balance, groups);
        for (place, track) in self.tracks.iter().enumerate().filter(|(_, track)| is_of_vehicle(track)) {
            let Some(judged) = self.judged(track, groups, scale) else { continue };
            let (what, unit) = (Changed::Parameter(place), track.unit);
            least.push(LeastChange { what, size: judged.least, unit });
            let change = Change {
                what,
                moved: Some(judged.moved),
                unit,
                sigmas: judged.moved.sigmas().abs(),
                carried_by: judged.carried_by,
                rivals: Vec::new(),
            };
            match judged.undecided {
                _ if judged.changed => changes.push(change),
                Some(why) => undecided.push((change, why)),
                None => {}
            }
        }
        changes.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
        undecided.sort_by(|(a, _), (b, _)| b.sigmas.total_cmp(&a.sigmas));
        let mut compared = Compared { balance, changes, undecided, least, other_vehicle: None };
        let are_several = compared.moved_by_motion(UNDECIDED) >= OTHER_PARAMETERS;
        compared.other_vehicle = self.differing_lifts(groups).filter(|_| are_several);
        compared
    }

    /// Of what the balance tells keeps what a rotor that the motion names does not account for.
    fn keep_beside(
        &self,
        changes: &mut Vec<Change>,
        rotor: &RotorMoved,
        (balance, groups): (&BalanceChange, &Groups),
    ) {
        let known = (rotor.rotor, rotor.moved.after);
        let left = left_beside_rotor((self.balance, balance), groups, self.vehicle, known);
        let is_of_balance =
            |what: Changed| matches!(what, Changed::Balance | Changed::CentreOfMass(_) | Changed::YawTorque);
        changes.retain(|change| !is_of_balance(change.what) || left >= NAMED);
        for change in changes.iter_mut().filter(|change| change.what == Changed::Balance) {
            change.sigmas = change.sigmas.min(left.sqrt());
            change.rivals.retain(|rival| *rival != What::Rotor(rotor.rotor));
        }
    }

    /// Whether a parameter moved, where the scale that it goes with may have moved.
    pub(super) fn judged(
        &self,
        track: &Track,
        groups: &Groups,
        scale: Option<ScaleMoved>,
    ) -> Option<ParameterChange> {
        let factor =
            scale.filter(|_| follows_force(track.unit)).map(|scale| scale.factor(self.vehicle.anchor));
        match factor {
            Some(factor) => judge_at_both_scales(&track.values, groups, &track.spread, factor),
            None => judge_parameter(&track.values, groups, &track.spread),
        }
    }

    /// Where the scale of forces moved by enough to be told: between the groups, or along all flights.
    #[must_use]
    pub fn scale(&self, groups: Option<&Groups>) -> Option<ScaleMoved> {
        let moved = match groups {
            Some(groups) => ScaleMoved::between(self.balance, groups),
            None => ScaleMoved::along(self.balance),
        };
        moved.filter(ScaleMoved::is_told)
    }

    /// Whether the balance moved without a name: between the groups, or at a border between all flights.
    #[must_use]
    pub fn moved_without_name(&self, groups: Option<&Groups>) -> bool {
        let has_none = |groups: &Groups| {
            let Compared { balance, changes, .. } = self.compared(groups);
            let has = |wanted: fn(&Changed) -> bool| changes.iter().any(|change| wanted(&change.what));
            // a rotor that the motion names may account for it
            let is_told =
                has(|what| matches!(what, Changed::Rotor(_))) && !has(|what| *what == Changed::Balance);
            balance.moved_without_name() && !is_told
        };
        let count = self.balance.flights.len();
        match groups {
            Some(groups) => has_none(groups),
            None => (1..count).any(|from| has_none(&Groups::split(count, from))),
        }
    }

    /// Length of an arm and its unit: one arm where lengths are not known.
    fn arm(&self) -> (f64, &'static str) {
        if self.is_known { (mean_arm_m(self.vehicle), "m") } else { (1.0, "arm") }
    }

    fn of_balance(&self, balance: &BalanceChange) -> Vec<Change> {
        let Some(found) = &balance.found else { return Vec::new() };
        let (arm, length) = self.arm();
        let change = |what, moved, unit, sigmas| Change {
            what,
            moved,
            unit,
            sigmas,
            carried_by: found.carried_by.clone(),
            rivals: found.rivals.clone(),
        };
        let sigmas = found.strength.sqrt();
        match found.what {
            Some(What::Rotor(rotor)) => vec![change(Changed::Rotor(rotor), found.factor, "-", sigmas)],
            Some(What::CentreOfMass) => {
                let along = |axis: usize| {
                    let moved = balance.beside_a_load(axis).times(arm);
                    change(Changed::CentreOfMass(axis), Some(moved), length, moved.sigmas().abs())
                };
                // the axis along which it stayed is no change
                let mut axes = [0, 1].map(along);
                axes.sort_by(|a, b| b.sigmas.total_cmp(&a.sigmas));
                let [first, second] = axes;
                let second = Some(second).filter(|of| of.sigmas >= STAYED);
                std::iter::once(first).chain(second).collect()
            }
            Some(What::YawTorque) => vec![change(Changed::YawTorque, Some(balance.moved[2]), "-", sigmas)],
            None => vec![change(Changed::Balance, None, "-", sigmas)],
        }
    }

    fn least_of_balance(&self, balance: &BalanceChange) -> Vec<LeastChange> {
        let (arm, length) = self.arm();
        let of_rotor = |(rotor, size): (usize, &f64)| LeastChange {
            what: Changed::Rotor(rotor),
            size: *size,
            unit: "-",
        };
        let centre = [0, 1].map(|axis| LeastChange {
            what: Changed::CentreOfMass(axis),
            size: balance.least.centre * arm,
            unit: length,
        });
        balance.least.rotors.iter().enumerate().map(of_rotor).chain(centre).collect()
    }
}

/// What the motion alone tells of a rotor.
fn of_rotor(RotorMoved { rotor, moved, carried_by }: RotorMoved) -> Change {
    Change {
        what: Changed::Rotor(rotor),
        moved: Some(moved),
        unit: "-",
        sigmas: moved.sigmas().abs(),
        carried_by,
        rivals: Vec::new(),
    }
}

/// Standard deviations that chance reaches at one of so many places: the root of twice their logarithm.
pub(super) fn beyond(places: usize) -> f64 {
    (2.0 * (places.max(1) as f64).ln()).sqrt()
}

/// Standard deviations that a change at one of the borders between so many flights needs.
fn at_a_border(flights: usize) -> f64 {
    NAMED_SIGMAS.hypot(beyond(flights.saturating_sub(1)))
}

/// Groups of places in an order as groups of flights.
pub(super) fn flight_groups(groups: &Groups, order: &[usize]) -> Groups {
    let of = |places: &[usize]| places.iter().map(|place| order[*place]).collect();
    Groups { before: of(&groups.before), after: of(&groups.after) }
}

/// Whether a parameter is the vehicle's, and may have changed.
pub(super) fn is_of_vehicle(track: &Track) -> bool {
    track.owner == Owner::Vehicle && !is_of_battery(track)
}

/// Whether a parameter tells how thrust follows the voltage: each flight has its own battery, and only one that is drained shows it.
fn is_of_battery(track: &Track) -> bool {
    let signature = track.effect.and_then(signature_of);
    signature.is_some_and(|signature| signature.needs.contains(&Need::Voltage))
}
