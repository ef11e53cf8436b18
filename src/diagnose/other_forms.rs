//! Effects with more than one form: the form that explains more is kept.

use super::fit::{Fitted, Newton, fit};
use super::price::Price;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// Changes the form of an effect if another form costs less: it explains more than its columns and nuisances cost.
/// Returns whether a form was changed.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn other_form(flights: &[Trace], fitted: &mut Fitted, price: Price) -> Result<bool, PhysicsError> {
    let mut taken = false;
    for place in 0..fitted.base.effects.len() {
        let term = &fitted.base.effects[place];
        for form in (term.signature.refinement.other_forms)(term) {
            let mut base = fitted.base.clone();
            let values = form.values.iter().enumerate();
            let possible = values.map(|(slot, value)| form.possible(slot, *value, &base.size)).collect();
            base.effects[place] = EffectTerm { values: possible, ..form };
            let other = fit(flights, base, Newton::Held)?;
            if price.cost(&other) < price.cost(fitted) {
                *fitted = other;
                taken = true;
            }
        }
    }
    Ok(taken)
}
