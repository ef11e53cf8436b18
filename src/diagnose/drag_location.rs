//! The point at which a drag acts: the rotors' hubs, the centre of mass, or both.
//!
//! Drag at the hubs also damps the rotation. A body with drag at its centre and a damped rotation therefore resembles
//! one with drag partly at the hubs. One point together with damping is the simpler description. Where the share at the hubs stays in the
//! model, its error has what a damping that the model does not have may bring into it (consider covariance).

use super::base::Base;
use super::evidence::weighted;
use super::fit::{Fitted, Newton, fit};
use super::other_law::second_moment;
use super::price::Price;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;
use nalgebra::Vector3;

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

/// Largest variance of a share, of which no more is known than that it is between none and all (a uniform law about any value in it).
const UNKNOWN_SHARE: f64 = 1.0 / 3.0;

/// Adds to the variance of a drag's share at the hubs what a damping of the rotation that the model does not have may bring into it: up to
/// the damping that the whole drag would bring from the hubs, as far as the flights do not exclude it.
pub(super) fn add_damping(flights: &[Trace], fitted: &mut Fitted) {
    let mut index = fitted.rows.nuisances.len();
    let mut shares: Vec<(usize, f64)> = Vec::new();
    for present in &fitted.base.effects {
        for &slot in &present.free {
            if present.is_share_at_hubs(slot) {
                let brought = by_damping(flights, fitted, (present, index)).unwrap_or(0.0);
                shares.push((index, brought));
            }
            index += 1;
        }
    }
    for (index, brought) in shares {
        let before = fitted.covariance[(index, index)];
        let after = (before + brought).min(UNKNOWN_SHARE);
        if after < before {
            // what is shared with others goes with it
            let ratio = (after / before).sqrt();
            fitted.covariance.column_mut(index).scale_mut(ratio);
            fitted.covariance.row_mut(index).scale_mut(ratio);
        } else {
            fitted.covariance[(index, index)] = after;
        }
    }
}

/// Variance that a damping brings into the share at the hubs with this `index`, about the axes about which the model has none; `None` where
/// there can be none.
fn by_damping(flights: &[Trace], fitted: &Fitted, (drag, index): (&EffectTerm, usize)) -> Option<f64> {
    let damping = drag.signature.role.damped_by?();
    let base = &fitted.base;
    let present = base.effects.iter().find(|term| term.is(damping.signature));
    let has = |slot: &usize| present.is_some_and(|present| present.free.contains(slot));
    let columns = fitted.rows.columns_of(flights, base, &damping).ok()?;
    let most = damping_at_hubs(drag, base);
    let each = damping.free.iter().zip(&columns).zip(most.iter()).filter(|((slot, _), _)| !has(slot));
    let each = each.map(|((_, column), &most)| {
        let evidence = fitted.weighted.test(std::slice::from_ref(column));
        let (told, std) = evidence.map_or((0.0, f64::INFINITY), |of| (of.theta[0], of.std(0)));
        let brings = fitted.weighted.part_in(&weighted(column, &fitted.weighted.sigma))[index];
        if most > 0.0 { brings.powi(2) * second_moment(told, std, most) } else { 0.0 }
    });
    Some(each.sum())
}

/// Damping about body x, y, z (N m s) of a rotation at the centre of mass, where the whole drag acts at the hubs.
fn damping_at_hubs(drag: &EffectTerm, base: &Base) -> Vector3<f64> {
    let of = |term: &EffectTerm, name: &str| {
        let slot = term.effect().parameters().iter().position(|parameter| parameter.name == name);
        slot.map_or(0.0, |slot| term.values[slot].abs())
    };
    // an inflow is the drag along z of its own, or of the one that it is a part of
    let is_part = |term: &&EffectTerm| {
        term.signature.role.axial_part_of.is_some_and(|whole| whole.id() == drag.effect().id())
    };
    let [dx, dy] = ["dx", "dy"].map(|name| of(drag, name));
    let parts: f64 = base.effects.iter().filter(is_part).map(|term| of(term, "kz")).sum();
    let dz = of(drag, "dz") + of(drag, "kz") + parts;
    let vehicle = &base.vehicle;
    let squares = vehicle.rotors.iter().map(|rotor| rotor.position_m.component_mul(&rotor.position_m));
    let r2 = squares.sum::<Vector3<f64>>() / vehicle.rotors.len().max(1) as f64;
    Vector3::new(dy * r2.z + dz * r2.y, dz * r2.x + dx * r2.z, dx * r2.y + dy * r2.x)
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
