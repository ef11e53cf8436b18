//! The yaw torque that rotors take to spin up, out of the motion.
//!
//! With the rotors' inertia `jr` the yaw torque of the measured motion is that of their drag and `L` times its rate,
//! `tau = tau_drag + L tau_drag'`, about hover with `L = jr Omega / (2 c T)` of one rotor's speed, thrust and torque per
//! thrust. `L` is often longer than the motion's periods, so `tau_drag` is `tau` behind a lag of `L`; subtracting what
//! the last pass found would not converge.

use super::base::Base;
use super::rotors::RotorMotion;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::{
    ActuationLatency, Airframe, Condition, Effect, Input, Own, Rotors, State, Wrench, delayed_wrench,
};
use crate::vehicle::RigidBody;
use nalgebra::{Vector3, Vector4};

/// The rotors' inertia in a base.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpinUp {
    effect: &'static dyn Effect,
    jr_kg_m2: f64,
    /// time constant `L` of the yaw torque, s
    lag_s: f64,
}

impl SpinUp {
    /// `None` where the base has no rotor inertia, or the rotors no speed.
    pub(super) fn of(base: &Base, airframe: &Airframe) -> Option<Self> {
        let inertia = |term: &EffectTerm| Some((term.effect(), term.values[term.signature.role.spin_up?]));
        let (effect, jr_kg_m2) = base.effects.iter().find_map(inertia).filter(|(_, jr)| *jr > 0.0)?;
        let drag_nm = airframe.propulsion.torque_per_thrust_m * airframe.hover_thrust_n;
        let lag_s = jr_kg_m2 * airframe.hover_speed_rad_s? / (2.0 * drag_nm);
        lag_s.is_finite().then_some(Self { effect, jr_kg_m2, lag_s })
    }

    /// Replaces the spin-up torque (N m about z) in `effects` (`[Fz tau]` in addition to the rotors' own), computed
    /// from `motion`, by the one of this lag.
    pub(super) fn share(
        &self,
        trace: &Trace,
        (airframe, motion): (&Airframe, &RotorMotion),
        body: &RigidBody,
        effects: &mut [Vector4<f64>],
    ) {
        let turning = trace.turning_torque(body);
        let beside: Vec<Vector4<f64>> = effects
            .iter()
            .enumerate()
            .map(|(index, effects)| {
                let spinning_nm = self.torque_nm(airframe, &trace.states[index], motion, index);
                Vector4::new(turning[index].z - (effects[3] - spinning_nm), 0.0, 0.0, 0.0)
            })
            .collect();
        let behind = ActuationLatency { lag_s: self.lag_s, ..ActuationLatency::default() };
        let of_drag = delayed_wrench(&beside, trace.grid.step_s, behind);
        for (index, effects) in effects.iter_mut().enumerate() {
            // the rest of what the motion took beside the other effects
            effects[3] = turning[index].z - of_drag[index].x;
        }
    }

    /// Torque of the effect itself for the rotors' motion, about z, N m.
    fn torque_nm(&self, airframe: &Airframe, state: &State, motion: &RotorMotion, index: usize) -> f64 {
        let input = Input::from_commands(airframe, 0.0, &[]);
        let at = Condition::new(airframe, state, &input, Vector3::zeros());
        let mut rotors = Rotors::still();
        rotors.speed = motion.speed.at(index);
        rotors.acceleration_1_s = motion.acceleration_1_s.at(index);
        let mut sum = Wrench::zero();
        let mut own = Own { parameters: &[self.jr_kg_m2], states: &[], rates: &mut [] };
        self.effect.wrench(&at, &rotors, &mut own, &mut sum);
        sum.torque_nm.z
    }
}
