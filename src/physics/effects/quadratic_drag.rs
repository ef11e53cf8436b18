//! The body drags with the square of the airspeed.

use crate::physics::{Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

/// `F = -|v_air| diag(cx, cy, cz) v_air` at the centre of mass; `c = rho CdA / 2` of a face.
///
/// Hoerner 1965; ArduPilot's ballistic coefficients.
#[derive(Debug, Clone, Copy)]
pub struct QuadraticDrag;

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "cx", unit: "N/(m/s)^2", min: 0.0, max: 2.0 },
    Parameter { name: "cy", unit: "N/(m/s)^2", min: 0.0, max: 2.0 },
    Parameter { name: "cz", unit: "N/(m/s)^2", min: 0.0, max: 2.0 },
];

impl Effect for QuadraticDrag {
    fn id(&self) -> &'static str {
        "quadratic_drag"
    }

    fn sentence(&self) -> &'static str {
        "The body drags: a force against the airspeed that grows with its square."
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let area = own.axes();
        let v = at.air_velocity_m_s;
        sum.force_n -= v.component_mul(&area) * v.norm();
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, _rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        let v = at.air_velocity_m_s;
        for (axis, column) in columns.iter_mut().enumerate().take(PARAMETERS.len()) {
            *column = Wrench::zero();
            column.force_n[axis] = -v.norm() * v[axis];
        }
    }
}
