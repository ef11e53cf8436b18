//! One rotor gives less (or more) than the others.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, MAX_ROTORS, Own, Parameter, Rotors, Wrench};

documented! {
    /// `T_i = factor T`, and the reaction torque changes by the same factor, for the rotor of this number. In
    /// files, rotors are counted from 0 in the order of the vehicle file: the autopilot's motor 1 is 0.
    #[derive(Debug, Clone, Copy)]
    pub struct WeakRotor;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "rotor", unit: "-", bounds: Bounds::of(0.0, 7.0) },
    Parameter { name: "factor", unit: "-", bounds: Bounds::of(0.5, 1.2) },
];

/// Which rotor the parameter names; past the last where there is none.
fn slot(parameters: &[f64]) -> usize {
    (0..MAX_ROTORS).find(|slot| (*slot as f64 - parameters[0]).abs() < 0.5).unwrap_or(MAX_ROTORS)
}

impl Effect for WeakRotor {
    fn id(&self) -> &'static str {
        "weak_rotor"
    }

    fn sentence(&self) -> &'static str {
        "One rotor is weak: its thrust and torque are less than those of the others."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::RotorThrust]
    }

    fn rotor_thrust(&self, _at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        if let Some(thrust_n) = rotors.thrust_n.get_mut(slot(own.parameters)) {
            *thrust_n *= own.parameters[1];
        }
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [by_rotor, by_factor] = columns else { return };
        let mut alone_n = [0.0; MAX_ROTORS];
        if let (Some(alone_n), Some(thrust_n)) =
            (alone_n.get_mut(slot(parameters)), rotors.thrust_n.get(slot(parameters)))
        {
            *alone_n = *thrust_n;
        }
        // a rotor's number has no slope
        (*by_rotor, *by_factor) = (Wrench::zero(), at.thrust_wrench(&alone_n));
    }
}
