//! Effects that are written in more than one form: the one that explains more is kept.
//!
//! About nothing the forms of the ground effect look alike; with the size that they come to they do not.

use super::base::Present;
use super::fit::{Fitted, Newton, fit};
use super::hubs::cost;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// Slots of the ground effect's values.
const RHO: usize = 0;
const CA: usize = 1;
const CB: usize = 2;
/// Decays that the exponential form starts from, per rotor radius.
const DECAYS: [f64; 2] = [0.7, 1.5];
/// Where both forms are to give the same at first, rotor radii.
const ALIKE_RADII: f64 = 2.0;

/// Puts the ground effect of a fit into its other form where that explains more than its columns cost (`price` a
/// column, in squared sigmas). Returns whether it did.
pub(super) fn other_form(flights: &[Trace], fitted: &mut Fitted, price: f64) -> Result<bool, PhysicsError> {
    let Some(place) = fitted.base.present.iter().position(|present| present.effect.id() == "ground_effect")
    else {
        return Ok(false);
    };
    let mut taken = false;
    for form in others(&fitted.base.present[place]) {
        let mut base = fitted.base.clone();
        base.present[place] = form;
        let other = fit(flights, base, Newton::Held)?;
        if cost(&other, price) < cost(fitted, price) {
            *fitted = other;
            taken = true;
        }
    }
    Ok(taken)
}

/// The same size in the other form.
fn others(present: &Present) -> Vec<Present> {
    let (rho, ca, cb) = (present.values[RHO], present.values[CA], present.values[CB]);
    let beside = present.free.iter().copied().filter(|slot| ![RHO, CA, CB].contains(slot));
    let of = |slots: &[usize], values: [f64; 3]| {
        let mut other = present.clone();
        other.values[..3].copy_from_slice(&values);
        other.free = slots.iter().copied().chain(beside.clone()).collect();
        for slot in 0..3 {
            other.values[slot] = other.possible(slot, other.values[slot]);
        }
        other
    };
    let squared = 16.0 * ALIKE_RADII * ALIKE_RADII;
    if ca > 0.0 {
        let gain = ca * (-cb * ALIKE_RADII).exp();
        return vec![of(&[RHO], [squared * gain / (1.0 + gain), 0.0, cb])];
    }
    let gain = 1.0 / (1.0 - rho / squared) - 1.0;
    DECAYS.iter().map(|decay| of(&[CA, CB], [0.0, gain * (decay * ALIKE_RADII).exp(), *decay])).collect()
}
