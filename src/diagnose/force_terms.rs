//! The effects of a model as the reconstruction of a flight takes them: those of their parameters free that forces tell.

use super::base::Base;
use super::pooled_estimate::PooledEstimate;
use super::signature::EffectTerm;
use super::signatures::is_near;
use crate::physics::{Airframe, Condition, Hook, Input, MAX_ROTORS, Rotors, State, effects_wrench};
use crate::reconstruction::Term;
use nalgebra::Vector3;

/// Free values of effects at those that another fit of the same effects found.
pub(super) fn begin_at(terms: &mut [Term], opened: &[Term], pooled: &PooledEstimate) {
    let mut first = 1;
    for (term, open) in terms.iter_mut().zip(opened) {
        for &slot in &term.free {
            if let Some(place) = open.free.iter().position(|free| *free == slot) {
                term.values[slot] = pooled.values[first + place];
            }
        }
        first += open.free.len();
    }
}

/// The effects of the model with those of their parameters free that the forces tell; `None` where one of them has states or
/// changes what sensors show, but for an accelerometer near the centre of mass.
pub(super) fn terms(base: &Base) -> Option<Vec<Term>> {
    let airframe = Airframe::new(&base.vehicle).ok()?;
    let one = |term: &EffectTerm| {
        let effect = term.effect();
        let shows_otherwise = effect.hooks().contains(&Hook::Sensors) && !is_near(term);
        if shows_otherwise || effect.state_count(&airframe) > 0 {
            return None;
        }
        let role = &term.signature.role;
        let told = |slot: &usize| {
            let of_form = role.with_speed.is_some_and(|(own, _)| own == *slot);
            let by_force = role.wind.is_some() || role.of_air && pushes(term, *slot, &airframe, base);
            by_force && (term.is_amount(*slot) || of_form)
        };
        let free: Vec<usize> = term.free.iter().copied().filter(told).collect();
        let steps = free.iter().map(|&slot| term.step_of(slot, &base.size)).collect();
        Some(Term::new(effect, term.values.clone(), free, steps))
    };
    base.effects.iter().map(one).collect()
}

/// Whether a value of an effect of the air changes the force, and not the torque alone: in forward flight and climb, or in a
/// descent.
fn pushes(term: &EffectTerm, slot: usize, airframe: &Airframe, base: &Base) -> bool {
    let rotors = Rotors::as_commanded(airframe, &[1.1; MAX_ROTORS]);
    let input = Input { speed_command: rotors.speed, ..Input::from_commands(airframe, 0.0, &[]) };
    let mut moved = term.values.clone();
    moved[slot] += term.step_of(slot, &base.size);
    [Vector3::new(2.0, -1.0, 1.5), Vector3::new(0.5, 0.3, -3.0)].into_iter().any(|velocity_m_s| {
        let state = State { velocity_m_s, ..State::at_rest(Vector3::z(), 0.3) };
        let at = Condition::new(airframe, &state, &input, Vector3::zeros());
        let force_n = |parameters: &[f64]| {
            effects_wrench(std::iter::once((term.effect(), parameters)), &at, &rotors).force_n
        };
        force_n(&moved) != force_n(&term.values)
    })
}
