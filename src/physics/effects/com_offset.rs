//! The centre of mass is not where the vehicle file has it.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// Every force at a hub acts about the true centre of mass c: `tau = sum (r_i - c) x F_i`, which for thrust alone is
    /// `-c x T e_z = (-c_y T, c_x T, 0)`. The state is that of the true centre of mass, so nothing else changes. The z
    /// component acts only through forces across the thrust axis.
    #[derive(Debug, Clone, Copy)]
    pub struct ComOffset;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
    Parameter { name: "y", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
    Parameter { name: "z", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
];

impl Effect for ComOffset {
    fn id(&self) -> &'static str {
        "com_offset"
    }

    fn sentence(&self) -> &'static str {
        "The centre of mass is off: thrust turns the vehicle about it."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn sided(&self) -> &'static [usize] {
        &[1]
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::CenterOfMass]
    }

    fn center_of_mass_m(&self, own: &Own) -> Vector3<f64> {
        own.axes()
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        let thrust = at.thrust_wrench(&rotors.thrust_n).force_n;
        for (axis, column) in columns.iter_mut().enumerate().take(PARAMETERS.len()) {
            *column =
                Wrench { force_n: Vector3::zeros(), torque_nm: -Vector3::ith(axis, 1.0).cross(&thrust) };
        }
    }
}
