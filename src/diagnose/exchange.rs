//! One effect in place of another that explains nearly the same: others may then be superfluous.
//!
//! A search takes one effect at a time. Of two that explain nearly the same it may take the wrong one, and then others that mend
//! what this one gets wrong: a wind in place of a centre of mass that is off needs a misaligned position reference beside it.

use super::acceptance::accepted;
use super::candidates::{Candidate, candidates};
use super::fit::{Fitted, Newton, fit};
use super::gates::{Gates, NAME_Z, passes};
use super::price::Price;
use super::refinement::{fitted_strength, with_first_columns, without};
use super::score::test_all;
use super::signature::Signature;
use super::signatures::signature_of;
use super::tested::{Step, Tested};
use super::trace::Trace;
use crate::physics::PhysicsError;

/// Puts a rival in the place of the effect that was taken before it, where the model then costs less. Returns the rival with its
/// evidence. What acts as a latency has its delay in its place, and is not exchanged.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn exchanged(
    flights: &[Trace],
    after: &mut Fitted,
    (steps, price): (&[Step], Price),
    (gates, signatures, refused): (&Gates, &[&'static Signature], &[&'static str]),
) -> Result<Option<Tested>, PhysicsError> {
    let mut best: Option<(Tested, Fitted)> = None;
    for (place, term) in after.base.effects.iter().enumerate() {
        let rivals = rivals(after, steps, (term.id(), refused));
        if rivals.is_empty() {
            continue;
        }
        let left = fit(flights, without(&after.base, |of| of == place), Newton::Held)?;
        let all = candidates(&left.base.vehicle, flights, signatures);
        let open: Vec<Candidate> = all.iter().filter(|of| rivals.contains(&of.id)).cloned().collect();
        let tested = test_all(flights, &left, &open, signatures);
        let serves =
            |of: &Tested| rivals.contains(&of.candidate.id) && passes(of, &left, gates, all.len() as f64);
        let served = tested.into_iter().filter(serves);
        let Some(rival) = served.max_by(|a, b| price.worth(a).total_cmp(&price.worth(b))) else { continue };
        let Some((taken, with)) = accepted(flights, &left, rival)? else { continue };
        let with = without_superfluous(flights, with)?;
        tracing::debug!(
            effect = term.id(),
            by = taken.candidate.id,
            cost = price.cost(&with),
            present = price.cost(after),
            "exchange tried"
        );
        let least = best.as_ref().map_or_else(|| price.cost(after), |(_, best)| price.cost(best));
        if with.base.effects.iter().any(|of| of.id() == taken.candidate.id) && price.cost(&with) < least {
            tracing::info!(effect = term.id(), by = taken.candidate.id, "effect exchanged");
            best = Some((taken, with));
        }
    }
    Ok(best.map(|(taken, with)| {
        *after = with;
        taken
    }))
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
            with_first_columns(&fitted).map(|(present, first)| fitted_strength(&fitted, present, first));
        let weakest = strengths.enumerate().filter(|(_, of)| of.count > 0 && of.z < NAME_Z);
        let Some((place, _)) = weakest.min_by(|(_, a), (_, b)| a.z.total_cmp(&b.z)) else {
            return Ok(fitted);
        };
        fitted = fit(flights, without(&fitted.base, |of| of == place), Newton::Held)?;
    }
}
