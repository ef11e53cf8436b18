//! Forms of forces that the reconstructed flight path tells: whether a drag is the body's or grows with the rotors' speed.

use super::base::Base;
use super::pooled_estimate::PooledEstimate;
use super::signature::EffectTerm;
use crate::reconstruction::Term;

/// A share that grows with the rotors' speed is told apart beyond this many standard errors.
const TOLD_APART: f64 = 2.0;

/// Each effect in the form that its share tells.
pub(super) fn choose_forms(base: &mut Base, opened: &[Term], pooled: &PooledEstimate) {
    let mut next = 1;
    for (present, term) in base.effects.iter_mut().zip(opened) {
        for &slot in &term.free {
            if present.signature.role.with_speed.is_some_and(|(own, _)| own == slot) {
                choose_form(present, slot, (pooled.values[next], pooled.std(next)));
            }
            next += 1;
        }
    }
    let damped = base.effects.clone();
    for present in &mut base.effects {
        let role = &present.signature.role;
        let of_body = role.with_speed.is_some_and(|(slot, _)| present.values.get(slot) == Some(&0.0));
        let damping = role.damped_by.map(|damping| damping()).filter(|_| of_body);
        if damping.is_some_and(|damping| damped.iter().any(|other| other.is(damping.signature))) {
            // a drag of the body acts at its centre, and what else damps the rotation is in the model
            let at_hubs = present.effect().parameters().len();
            present.values[at_hubs] = 0.0;
            present.free.retain(|slot| *slot != at_hubs);
        }
    }
}

/// With the share that grows with the rotors' speed among the values, and free.
pub(super) fn open_form(present: &mut EffectTerm) {
    let Some((slot, common)) = present.signature.role.with_speed else { return };
    let given = present.effect().parameters().len();
    for (index, value) in common.iter().enumerate() {
        if present.values.len() == given + index {
            present.values.push(*value);
        }
    }
    if !present.free.contains(&slot) {
        present.free.push(slot);
    }
}

/// Of the body, where the share is nearer to none and one is excluded; else of the rotors.
fn choose_form(present: &mut EffectTerm, slot: usize, (share, std): (f64, f64)) {
    if share < 0.5 && 1.0 - share > TOLD_APART * std {
        let free = present.free.clone();
        open_form(present);
        present.free = free;
        present.values[slot] = 0.0;
    }
}
