//! One effect in place of several of one kind: two weak rotors can look like a centre of mass that is off.

use super::acceptance::accepted;
use super::candidates::candidates;
use super::fit::{Fitted, Newton, fit};
use super::gates::{Gates, passes};
use super::price::Price;
use super::score::test_all;
use super::signature::Signature;
use super::tested::Tested;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// Where an effect is in the model several times, the effect that explains most in their place, and the model with it; `None` where
/// that costs more.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn one_for_several(
    flights: &[Trace],
    fitted: &Fitted,
    price: Price,
    (gates, signatures, refused): (&Gates, &[&'static Signature], &[&'static str]),
) -> Result<Option<(Tested, Fitted)>, PhysicsError> {
    let present = &fitted.base.effects;
    let times = |id: &str| present.iter().filter(|term| term.id() == id).count();
    let Some(several) = present.iter().map(|term| term.id()).find(|id| times(id) > 1) else {
        return Ok(None);
    };
    let columns: usize = present.iter().filter(|term| term.id() == several).map(|term| term.free.len()).sum();
    let mut base = fitted.base.clone();
    base.effects.retain(|term| term.id() != several);
    let without = fit(flights, base, Newton::Held)?;
    let candidates = candidates(&without.base.vehicle, flights, signatures);
    let tested = test_all(flights, &without, &candidates, signatures);
    let count = tested.len() as f64;
    let serves = |tested: &Tested| {
        let id = tested.candidate.id;
        id != several
            && !refused.contains(&id)
            && tested.evidence.theta.len() <= columns
            && passes(tested, &without, gates, count)
    };
    let best = tested.into_iter().filter(serves).max_by(|a, b| price.worth(a).total_cmp(&price.worth(b)));
    let Some(best) = best else { return Ok(None) };
    let accepted = accepted(flights, &without, best)?;
    Ok(accepted.filter(|(_, with)| price.cost(with) < price.cost(fitted)))
}
