//! Rotation is damped in proportion to the body rates.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `tau = -diag(bx, by, bz) w`. The inflow at each rotor changes as its hub rises and sinks.
    #[derive(Debug, Clone, Copy)]
    pub struct AngularDamping;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "bx", unit: "N m/(rad/s)", bounds: Bounds::of(0.0, 1.0).by_mass().by_arm(2) },
    Parameter { name: "by", unit: "N m/(rad/s)", bounds: Bounds::of(0.0, 1.0).by_mass().by_arm(2) },
    Parameter { name: "bz", unit: "N m/(rad/s)", bounds: Bounds::of(0.0, 1.0).by_mass().by_arm(2) },
];

impl Effect for AngularDamping {
    fn id(&self) -> &'static str {
        "angular_damping"
    }

    fn sentence(&self) -> &'static str {
        "The rotation is damped: a torque against the body rates, in proportion to them."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let damping = own.axes();
        sum.torque_nm -= at.state.rates_rad_s.component_mul(&damping);
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, _rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        for (axis, column) in columns.iter_mut().enumerate().take(PARAMETERS.len()) {
            *column = Wrench::zero();
            column.torque_nm[axis] = -at.state.rates_rad_s[axis];
        }
    }
}
