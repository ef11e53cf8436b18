//! Rotors take time to reach the commanded speed.

use crate::physics::{Airframe, Condition, Effect, Hook, Own, Parameter, Rotors};

/// `Omega' = (Omega_command - Omega) / time_constant`, one state a rotor.
#[derive(Debug, Clone, Copy)]
pub struct MotorLag;

/// Faster than this the rotor follows at once for every rate that a log has.
const LEAST_TIME_CONSTANT_S: f64 = 1e-4;

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "time_constant", unit: "s", min: LEAST_TIME_CONSTANT_S, max: 0.5 }];

impl Effect for MotorLag {
    fn id(&self) -> &'static str {
        "motor_lag"
    }

    fn sentence(&self) -> &'static str {
        "The rotors follow their commands late, as a first-order lag."
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
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
        let time_constant_s = own.parameters[0].max(LEAST_TIME_CONSTANT_S);
        for (rotor, state) in own.states.iter().enumerate() {
            let rate = (rotors.speed[rotor] - state) / time_constant_s;
            own.rates[rotor] = rate;
            rotors.speed[rotor] = *state;
            rotors.acceleration_1_s[rotor] = rate;
        }
    }
}
