//! One effect in place of another that explains nearly the same: others may then be superfluous.
//!
//! A search takes one effect at a time. Of two that explain nearly the same it may take the wrong one, and then others that mend
//! what this one gets wrong: a wind in place of a centre of mass that is off needs a misaligned position reference beside it.

use super::acceptance::accepted;
use super::candidates::{Candidate, candidates};
use super::fit::{Fitted, Newton, fit};
use super::gates::{Gates, NAME_Z, passes};
use super::price::Price;
use super::refinement::{fitted_strength, weakest};
use super::score::test_all;
use super::signature::Signature;
use super::signatures::signature_of;
use super::tested::{Step, Tested};
use super::trace::Trace;
use crate::physics::PhysicsError;

/// Puts a rival in the place of the effect that was taken before it, where the model then costs less. Returns the step, with what it
/// replaces among its rivals. What acts as a latency has its delay in its place, and is not exchanged.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn exchanged(
    flights: &[Trace],
    after: &mut Fitted,
    (steps, price): (&[Step], Price),
    (gates, signatures, refused): (&Gates, &[&'static Signature], &[&'static str]),
) -> Result<Option<Step>, PhysicsError> {
    let all = candidates(&after.base.vehicle, flights, signatures);
    let mut best: Option<(Step, Fitted)> = None;
    for (place, term) in after.base.effects.iter().enumerate() {
        let rivals = rivals(after, steps, (term.id(), refused));
        if rivals.is_empty() {
            continue;
        }
        let left = fit(flights, after.base.without(|of| of == place), Newton::Held)?;
        let open = |of: &&Candidate| of.id == term.id() || rivals.contains(&of.id);
        let open: Vec<Candidate> = all.iter().filter(open).cloned().collect();
        let (own, others): (Vec<Tested>, Vec<Tested>) = test_all(flights, &left, &open, signatures)
            .into_iter()
            .filter(|of| passes(of, &left, gates, all.len() as f64))
            .partition(|of| of.candidate.id == term.id());
        let is_open = |of: &Tested| {
            rivals.contains(&of.candidate.id)
                && of.candidate.parts.iter().all(|part| !refused.contains(&part.id()))
        };
        let Some(rival) = most(others.into_iter().filter(is_open), price) else { continue };
        let Some((taken, with)) = accepted(flights, &left, rival)? else { continue };
        drop(left);
        let with = without_superfluous(flights, with)?;
        let (id, by, cost, present) = (term.id(), taken.candidate.id, price.cost(&with), price.cost(after));
        tracing::debug!(effect = id, by, cost, present, "exchange tried");
        let least = best.as_ref().map_or(present, |(_, best)| price.cost(best));
        if cost < least && with.base.effects.iter().any(|of| of.id() == by) {
            let rivals = most(own.into_iter(), price).into_iter().collect();
            best = Some((Step { taken, rivals }, with));
        }
    }
    let Some((step, with)) = best else { return Ok(None) };
    // the other model had what it does not need taken out: this one has the same right
    if price.cost(&without_superfluous(flights, after.clone())?) <= price.cost(&with) {
        return Ok(None);
    }
    tracing::info!(by = step.taken.candidate.id, "effect exchanged");
    *after = with;
    Ok(Some(step))
}

/// What is worth most.
fn most(tested: impl Iterator<Item = Tested>, price: Price) -> Option<Tested> {
    tested.max_by(|a, b| price.worth(a).total_cmp(&price.worth(b)))
}

/// The effects that would have passed where this one was taken, and that the model does not have.
fn rivals(after: &Fitted, steps: &[Step], (id, refused): (&str, &[&'static str])) -> Vec<&'static str> {
    let is_exchanged = |id: &str| signature_of(id).is_some_and(|of| of.role.latency.is_none());
    let taken = steps.iter().filter(|step| step.taken.candidate.id == id && is_exchanged(id));
    let mut rivals: Vec<&'static str> =
        taken.flat_map(|step| step.rivals.iter().map(|of| of.candidate.id)).collect();
    rivals.retain(|&rival| {
        let is_present = after.base.effects.iter().any(|of| of.id() == rival);
        !is_present && is_exchanged(rival) && !refused.contains(&rival)
    });
    rivals
}

/// The model without the effects that are not certain in it, one after the other.
fn without_superfluous(flights: &[Trace], mut fitted: Fitted) -> Result<Fitted, PhysicsError> {
    loop {
        let strengths =
            fitted.with_first_columns().map(|(present, first)| fitted_strength(&fitted, present, first));
        let Some((_, place)) = weakest(strengths.enumerate(), NAME_Z) else { return Ok(fitted) };
        fitted = fit(flights, fitted.base.without(|of| of == place), Newton::Held)?;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::base::Base;
    use crate::diagnose::latency::fit_latency;
    use crate::diagnose::made_flights::flown;
    use crate::physics::ActiveEffect;
    use crate::physics::effects::by_id;
    use crate::simulate::RandomTrajectory;

    #[test]
    fn the_law_that_a_flight_has_takes_the_place_of_the_other_one_and_stays() {
        let (signals, vehicle) = flown(41, &RandomTrajectory::default(), |truth, weight_n| {
            let drag = by_id("quadratic_drag").unwrap();
            truth.effects.push(ActiveEffect::new(drag, &[0.012 * weight_n; 3]).unwrap());
        });
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let (before, _) = fit_latency(&flights, Base::anchored(&vehicle)).unwrap();
        let signatures = ["linear_drag", "quadratic_drag"].map(|id| signature_of(id).unwrap());
        let tested = test_all(&flights, &before, &candidates(&vehicle, &flights, &signatures), &signatures);
        let most = |id: &str| {
            let of = tested.iter().filter(|of| of.candidate.id == id);
            of.max_by(|a, b| a.evidence.energy.total_cmp(&b.evidence.energy)).unwrap().clone()
        };
        for (taken, rival, found) in
            [("linear_drag", "quadratic_drag", true), ("quadratic_drag", "linear_drag", false)]
        {
            let (step, mut after) = accepted(&flights, &before, most(taken)).unwrap().unwrap();
            let price = Price::of(&after);
            let cost = price.cost(&after);
            let steps = [Step { taken: step, rivals: vec![most(rival)] }];
            let by = exchanged(&flights, &mut after, (&steps, price), (&Gates::default(), &signatures, &[]))
                .unwrap();
            assert_eq!(by.map(|of| of.taken.candidate.id), found.then_some(rival));
            let present: Vec<&str> = after.base.effects.iter().map(|term| term.id()).collect();
            assert_eq!(present, ["quadratic_drag"]);
            assert_eq!(price.cost(&after) < cost, found);
        }
    }
}
