//! Rotors take time to reach the commanded speed.

use crate::physics::equation::documented;
use crate::physics::{
    ActiveEffect, Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, RotorLag, Rotors,
};
use crate::vehicle::Propulsion;

documented! {
    /// `Omega' = (Omega_command - Omega) / time_constant`, with one state for each rotor. In the finer form,
    /// `time_constant` is that of a rotor that speeds up, and `time_constant_down` that of a rotor that slows down: the
    /// motor drives the rotor up, and often only the drag of the air slows it down.
    #[derive(Debug, Clone, Copy)]
    pub struct MotorLag;
}

/// Faster than this the rotor follows at once for every rate that a log has.
const LEAST_TIME_CONSTANT_S: f64 = 1e-4;
/// Least time constant that is integrated, s: a Runge-Kutta step of fourth order is stable up to 2.79 time constants, and playback takes steps of
/// 4 ms at most where rotors are that fast.
const LEAST_INTEGRATED_S: f64 = 2e-3;

const fn time_constant(name: &'static str) -> Parameter {
    Parameter { name, unit: "s", bounds: Bounds::of(LEAST_TIME_CONSTANT_S, 0.5) }
}

const PARAMETERS: &[Parameter] = &[time_constant("time_constant")];
const FINER: &[Parameter] = &[time_constant("time_constant_down")];

impl ActiveEffect {
    /// A lag of all rotors, with the same time constant (s) up and down.
    #[must_use]
    pub fn rotor_lag(time_constant_s: f64) -> Self {
        Self { effect: &MotorLag, parameters: vec![time_constant_s] }
    }

    /// Whether it is the lag of the rotors.
    #[must_use]
    pub fn is_rotor_lag(&self) -> bool {
        self.effect.id() == MotorLag.id()
    }

    /// The lag of the rotors that a vehicle's description states; `None` where it states none, or zero.
    #[must_use]
    pub fn stated_rotor_lag(propulsion: &Propulsion) -> Option<Self> {
        let up_s = propulsion.time_constant_s.filter(|up_s| *up_s > 0.0)?;
        let both_s = [up_s, propulsion.time_constant_down_s.unwrap_or(up_s)];
        let given = if propulsion.time_constant_down_s.is_some() { &both_s[..] } else { &both_s[..1] };
        Some(Self { effect: &MotorLag, parameters: given.to_vec() })
    }
}

impl Effect for MotorLag {
    fn id(&self) -> &'static str {
        "motor_lag"
    }

    fn sentence(&self) -> &'static str {
        "The rotors follow their commands late, as a first-order lag."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn finer_parameters(&self) -> &'static [Parameter] {
        FINER
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::RotorSpeed]
    }

    fn state_count(&self, airframe: &Airframe) -> usize {
        airframe.rotor_count()
    }

    fn initial_states(&self, _at: &Condition, rotors: &Rotors, states: &mut [f64]) {
        for (state, speed) in states.iter_mut().zip(&rotors.speed) {
            *state = *speed;
        }
    }

    fn rotor_speed(&self, _at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        let at_least = |time_constant_s: f64| time_constant_s.max(LEAST_INTEGRATED_S);
        let rising_s = at_least(own.parameters[0]);
        let falling_s = own.parameters.get(1).map_or(rising_s, |down_s| at_least(*down_s));
        let lag = RotorLag { rising_s, falling_s };
        let turning = rotors.speed.iter_mut().zip(&mut rotors.acceleration_1_s);
        for ((speed, acceleration), (state, rate)) in turning.zip(own.states.iter().zip(&mut *own.rates)) {
            *rate = lag.rate_1_s(*speed - state);
            (*speed, *acceleration) = (*state, *rate);
        }
    }
}
