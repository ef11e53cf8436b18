//! The body drags with the square of the airspeed.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `F = -|v_air| diag(cx, cy, cz) v_air` at the centre of mass, with `c = rho CdA / 2` of a face. In the finer form,
    /// the share `by_face` of the force depends on the speed along each axis alone, `F_i = -c_i |v_i| v_i`, as for flat
    /// faces.
    ///
    /// Hoerner 1965; ArduPilot's ballistic coefficients.
    #[derive(Debug, Clone, Copy)]
    pub struct QuadraticDrag;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "cx", unit: "N/(m/s)^2", bounds: Bounds::of(0.0, 2.0).by_mass() },
    Parameter { name: "cy", unit: "N/(m/s)^2", bounds: Bounds::of(0.0, 2.0).by_mass() },
    Parameter { name: "cz", unit: "N/(m/s)^2", bounds: Bounds::of(0.0, 2.0).by_mass() },
];

const FINER: &[Parameter] = &[Parameter { name: "by_face", unit: "-", bounds: Bounds::of(0.0, 1.0) }];

/// The speed that each axis' force goes with, m/s.
fn speed_m_s(v: &Vector3<f64>, parameters: &[f64]) -> Vector3<f64> {
    let by_face = parameters.get(PARAMETERS.len()).copied().unwrap_or(0.0);
    v.map(|v_i| (1.0 - by_face) * v.norm() + by_face * v_i.abs())
}

impl Effect for QuadraticDrag {
    fn id(&self) -> &'static str {
        "quadratic_drag"
    }

    fn sentence(&self) -> &'static str {
        "The body has drag: a force against the airspeed that grows with its square."
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
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let area = own.axes();
        let v = at.air_velocity_m_s;
        sum.force_n -= v.component_mul(&area).component_mul(&speed_m_s(&v, own.parameters));
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, _rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let v = at.air_velocity_m_s;
        let speed = speed_m_s(&v, parameters);
        for (axis, column) in columns.iter_mut().enumerate().take(PARAMETERS.len()) {
            *column = Wrench::zero();
            column.force_n[axis] = -speed[axis] * v[axis];
        }
    }
}
