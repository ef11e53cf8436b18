//! The forward search: fit, test every candidate, take the one that explains most, fit again.

use super::acceptance::accepted;
use super::base::Base;
use super::candidates::candidates;
use super::drag_location::one_place;
use super::exchange::exchanged;
use super::fit::{Fitted, Newton, fit};
use super::gates::{Gates, passes};
use super::grid_refinement::between_grid;
use super::latency::{LatencyFinding, finding_of, fit_latency};
use super::mounting::mountings;
use super::other_forms::other_form;
use super::overlooked::overlooked;
use super::pace::Pace;
use super::price::Price;
use super::pruning::{UNCHANGED_S, prune};
use super::score::test_all;
use super::signature::{EffectTerm, Signature};
use super::signatures::signature_of;
use super::substitution::one_for_several;
use super::tested::{Search, Step, Tested};
use super::trace::Trace;
use crate::physics::PhysicsError;
use crate::vehicle::Vehicle;

/// Runs the forward search. Effects of the list `never` are tested and not taken.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub fn search(
    flights: &[Trace],
    vehicle: &Vehicle,
    gates: &Gates,
    (signatures, never, pace): (&[&'static Signature], &[&'static str], &mut Pace<'_>),
) -> Result<Search, PhysicsError> {
    let _step = tracing::info_span!("search").entered();
    let (before, latency) = fit_latency(flights, Base::anchored(vehicle))?;
    let mut after = before.clone();
    let mut beside = latency;
    let mut steps: Vec<Step> = Vec::new();
    let mut last;
    let mut settled = 0;
    let mut refused: Vec<&'static str> = Vec::new();
    loop {
        refused.extend(never);
        let price = Price::of(&after);
        let mut passed;
        (passed, last) = ranked(flights, (&after, price), gates, signatures, &refused);
        // nor do they come back as the drag through which a wind acts
        passed.retain(|tested| tested.candidate.parts.iter().all(|part| !never.contains(&part.id())));
        tracing::debug!(candidates = last.len(), taken = steps.len(), "candidates tested");
        pace.tested();
        match passed.first() {
            Some(best) if after.base.effects.len() < gates.steps && steps.len() < 2 * gates.steps => {
                let id = best.candidate.id;
                match taken(flights, &mut after, passed, (price, gates, signatures, &refused))? {
                    Some(step) => {
                        step.emit();
                        steps.push(step);
                        // other moments had what this effect explains: what must stand out from them comes back
                        refused.retain(|id| {
                            signature_of(id).is_none_or(|signature| signature.role.moment.is_none())
                        });
                    }
                    None => {
                        tracing::debug!(effect = id, "effect refused");
                        refused.push(id);
                    }
                }
            }
            _ if settled == SETTLINGS || steps.is_empty() => break,
            _ => {
                if let Some(step) = overlooked(flights, &mut after, (&steps, price), (gates, &refused))? {
                    step.emit();
                    steps.push(step);
                    continue;
                }
                settled += 1;
                let step = exchanged(flights, &mut after, (&steps, price), (gates, signatures, &refused))?;
                let is_exchanged = step.is_some();
                steps.extend(step);
                let is_settled;
                (after, beside, is_settled) = pruned(flights, (after, beside), price, &mut refused)?;
                if is_settled && !is_exchanged {
                    break;
                }
            }
        }
    }
    let after = with_last(flights, after)?;
    let latency = told(finding_of(&after), latency, beside);
    let (by_wider_window, by_other_law) = ([f64::NAN; 3], Vec::new());
    let (misplaced, paths, laws_by_path) = (Vec::new(), Vec::new(), false);
    Ok(Search {
        before,
        after,
        latency,
        steps,
        last,
        by_wider_window,
        by_other_law,
        misplaced,
        paths,
        laws_by_path,
    })
}

/// The latency of the final model, with its kind as the rigid body alone tells it. What could be taken for a latency makes it uncertain,
/// whether it is in the model (`found`) or not (`beside`).
fn told(found: LatencyFinding, alone: LatencyFinding, beside: LatencyFinding) -> LatencyFinding {
    let LatencyFinding { against_lag, against_delay, uneven_std, .. } = alone;
    LatencyFinding { against_lag, against_delay, uneven_std, std_s: found.std_s.max(beside.std_s), ..found }
}

/// Takes the best of the candidates into the model, or what stands for it and others of its kind; `None` where it is refused.
fn taken(
    flights: &[Trace],
    after: &mut Fitted,
    mut passed: Vec<Tested>,
    (price, gates, signatures, refused): (Price, &Gates, &[&'static Signature], &[&'static str]),
) -> Result<Option<Step>, PhysicsError> {
    let rivals = passed.split_off(1);
    let Some(best) = passed.pop() else { return Ok(None) };
    let Some((taken, fitted)) = accepted(flights, after, best)? else { return Ok(None) };
    *after = fitted;
    Ok(Some(match one_for_several(flights, after, price, (gates, signatures, refused))? {
        Some((taken, fitted)) => {
            *after = fitted;
            // the others were rivals of what it replaces
            Step { taken, rivals: Vec::new() }
        }
        None => Step { taken, rivals },
    }))
}

/// The candidates that pass the gates, by worth, and all that were tested. Mountings are tested where no effect passes.
fn ranked(
    flights: &[Trace],
    (after, price): (&Fitted, Price),
    gates: &Gates,
    signatures: &[&'static Signature],
    refused: &[&'static str],
) -> (Vec<Tested>, Vec<Tested>) {
    let candidates = candidates(&after.base.vehicle, flights, signatures);
    let mut all = test_all(flights, after, &candidates, signatures);
    all.extend(between_grid(flights, after, &all));
    all.iter().for_each(Tested::emit);
    let count = all.len() as f64;
    let ranked = |tested: &[Tested]| {
        let open = tested.iter().filter(|tested| !refused.contains(&tested.candidate.id));
        let passed = open.filter(|tested| passes(tested, after, gates, count));
        weaker_first(by_worth(passed.cloned().collect(), price))
    };
    let mut passed = ranked(&all);
    if passed.is_empty() {
        let mounted = mountings(flights, after, signatures);
        passed = ranked(&mounted);
        all.extend(mounted);
    }
    (passed, all)
}

/// Removes from the model what it no longer needs and tries other forms of the rest. Returns it, its latency, and
/// whether the model stays as it is.
fn pruned(
    flights: &[Trace],
    (after, known): (Fitted, LatencyFinding),
    price: Price,
    refused: &mut Vec<&'static str>,
) -> Result<(Fitted, LatencyFinding, bool), PhysicsError> {
    let before = after.base.effects.clone();
    let (mut after, dropped, moved, found) = prune(flights, after, known)?;
    let placed = one_place(flights, &mut after, price)? | other_form(flights, &mut after, price)?;
    let gone = before.iter().map(|present| present.id());
    let kept = |id: &&'static str| after.base.effects.iter().any(|p| p.id() == *id);
    refused.extend(gone.filter(|id| !kept(id)).inspect(|effect| {
        tracing::info!(effect, "effect dropped from the model");
    }));
    Ok((after, found, !dropped && !placed && moved < UNCHANGED_S))
}

/// Sorts candidates by the energy that they explain less the price of its columns.
fn by_worth(mut tested: Vec<Tested>, price: Price) -> Vec<Tested> {
    tested.sort_by(|a, b| price.worth(b).total_cmp(&price.worth(a)));
    tested
}

/// Least share of the energy of a stronger rotor that a weaker one must explain to come first. Set by judgement: on a flight of a hexarotor
/// with a rotor at 0.93 both explained the same within 2 %.
const AS_MUCH: f64 = 0.93;

/// A weaker rotor before a stronger one that explains hardly more: a rotor loses thrust, and none gains any. Opposite rotors that turn in
/// opposite directions, as a hexarotor has them, turn the vehicle alike if one is the stronger or the other one the weaker.
fn weaker_first(mut passed: Vec<Tested>) -> Vec<Tested> {
    let change = |tested: &Tested| {
        let rotor = tested.candidate.signature().filter(|signature| signature.role.which.is_some());
        rotor.and(tested.evidence.theta.first().copied())
    };
    let is_stronger = |tested: &&Tested| change(tested).is_some_and(|change| change > 0.0);
    let Some(least) = passed.first().filter(is_stronger).map(|of| AS_MUCH * of.evidence.energy) else {
        return passed;
    };
    let is_weaker = |tested: &Tested| change(tested).is_some_and(|change| change < 0.0);
    if let Some(at) = passed.iter().position(|of| is_weaker(of) && of.evidence.energy > least) {
        let weaker = passed.remove(at);
        passed.insert(0, weaker);
    }
    passed
}

/// Fits the parameters that are estimated last (a ceiling's height), starting from the tried values, unless one reaches
/// its bound. During the comparison of effects they stay at the tried values, because they could otherwise explain the
/// part of other effects.
fn with_last(flights: &[Trace], fitted: Fitted) -> Result<Fitted, PhysicsError> {
    let has_last = |term: &EffectTerm| !term.signature.refinement.freed_last.is_empty();
    if !fitted.base.effects.iter().any(has_last) {
        return Ok(fitted);
    }
    let mut base = fitted.base.clone();
    for term in base.effects.iter_mut().filter(|term| has_last(term)) {
        term.free = term.signature.refinement.freed_last.to_vec();
    }
    let placed = fit(flights, base, Newton::Held)?;
    let bounded = placed
        .base
        .effects
        .iter()
        .filter(|of| has_last(of))
        .any(|of| of.free.iter().any(|&slot| of.is_at_bound(slot, &placed.base.size)));
    Ok(if placed.misfit() < fitted.misfit() && !bounded { placed } else { fitted })
}

/// How often effects are pruned and the search continues after no candidate passes any more. A number of steps: only
/// the time of a search and its last digits depend on it.
const SETTLINGS: usize = 2;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::made_flights::flown;
    use crate::simulate::RandomTrajectory;

    #[test]
    fn a_weaker_rotor_comes_before_a_stronger_one_that_explains_hardly_more() {
        let (signals, vehicle) = flown(23, &RandomTrajectory::default(), |_, _| {});
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let (before, _) = fit_latency(&flights, Base::anchored(&vehicle)).unwrap();
        let tested = |id: &str, change: f64, energy: f64| {
            let signatures = [signature_of(id).unwrap()];
            let all = candidates(&vehicle, &flights, &signatures);
            let mut of = test_all(&flights, &before, &all[..1], &signatures).remove(0);
            (of.evidence.theta[0], of.evidence.energy) = (change, energy);
            of
        };
        let rotor = |change: f64, energy: f64| tested("weak_rotor", change, energy);
        let order = |passed: Vec<Tested>| -> Vec<f64> {
            weaker_first(passed).iter().map(|of| of.evidence.theta[0]).collect()
        };
        let load = || tested("com_offset", 0.01, 99.5);
        let alike = vec![rotor(0.05, 100.0), load(), rotor(0.02, 99.0), rotor(-0.05, 98.0)];
        assert_eq!(order(alike), [-0.05, 0.05, 0.01, 0.02]);
        // more of it, and what is no rotor
        assert_eq!(order(vec![rotor(0.05, 100.0), rotor(-0.05, 80.0)]), [0.05, -0.05]);
        assert_eq!(order(vec![rotor(-0.05, 100.0), rotor(-0.06, 99.0)]), [-0.05, -0.06]);
        assert_eq!(order(vec![load(), rotor(-0.05, 99.0)]), [0.01, -0.05]);
        assert_eq!(order(Vec::new()), [0.0; 0]);
    }
}
