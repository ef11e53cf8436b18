//! The point at which a drag acts: the rotors' hubs, the centre of mass, or both.
//!
//! Drag at the hubs also damps the rotation. A body with drag at its centre and a damped rotation therefore resembles
//! one with drag partly at the hubs. One point together with damping is the simpler description.

use super::fit::{Fitted, Newton, fit};
use super::price::Price;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// A share at the hubs that is nearer than this to 0 or 1 counts as 0 or 1. Only the form of one drag depends on it.
const NEAR: f64 = 0.05;
/// A share at the hubs within this many standard errors of 0 or 1 counts as 0 or 1. The usual three; only the form of
/// one drag depends on it.
const NEAR_STD: f64 = 3.0;

/// Moves drags that seem to act partly at the hubs to one point if damping explains the flight as well. Returns whether
/// anything changed.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn one_place(flights: &[Trace], after: &mut Fitted, price: Price) -> Result<bool, PhysicsError> {
    let Some((place, slot)) = divided(after) else { return Ok(false) };
    let mut best: Option<(f64, Fitted)> = None;
    for at_hubs in [0.0, 1.0] {
        let mut base = after.base.clone();
        let drag = &mut base.effects[place];
        drag.values[slot] = at_hubs;
        drag.free.retain(|free| *free != slot);
        if let Some(damping) = base.effects[place].signature.role.damped_by.map(|damping| damping()) {
            match base.effects.iter_mut().find(|term| term.is(damping.signature)) {
                Some(known) => known.free = damping.free,
                None => base.effects.push(damping),
            }
        }
        let fitted = fit(flights, base, Newton::Held)?;
        let cost = price.cost(&fitted);
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, fitted));
        }
    }
    match best {
        Some((least, fitted)) if least < price.cost(after) => {
            *after = fitted;
            Ok(true)
        }
        _ => Ok(false),
    }
}

/// The first drag whose share at the hubs is neither 0 nor 1: its place among the effects and the slot of the share.
fn divided(fitted: &Fitted) -> Option<(usize, usize)> {
    let mut index = fitted.rows.nuisances.len();
    for (place, present) in fitted.base.effects.iter().enumerate() {
        for &slot in &present.free {
            let near = (NEAR_STD * fitted.covariance[(index, index)].max(0.0).sqrt()).max(NEAR);
            index += 1;
            let value = present.values[slot];
            if present.is_share_at_hubs(slot) && value > near && value < 1.0 - near {
                return Some((place, slot));
            }
        }
    }
    None
}
