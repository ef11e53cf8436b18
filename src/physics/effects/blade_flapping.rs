//! Blades flap in the airstream and the hubs turn the body.

use nalgebra::{Vector2, Vector3};

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `M_i = (k / N) n_i e_z x (v_air + w x r_i)` at each hub, where `k` is the coefficient of the whole vehicle at
    /// hover. Drag that acts at a height h above the centre of mass has the same form with `k = -h d`, so `k` may have
    /// either sign.
    ///
    /// Mahony, Kumar and Corke 2012; the form is RotorPy's `k_flap`.
    #[derive(Debug, Clone, Copy)]
    pub struct BladeFlapping;
}

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "k", unit: "N m/(m/s)", bounds: Bounds::of(-0.2, 0.2).by_mass().by_arm(1) }];

/// The torque for one N m/(m/s), N m.
fn per_coefficient(at: &Condition, rotors: &Rotors) -> Vector3<f64> {
    let mut flow_m_s = Vector2::zeros();
    for ((_, air), speed) in at.hubs().zip(&rotors.speed) {
        flow_m_s += air.xy() * *speed;
    }
    let flow_m_s = flow_m_s / at.airframe.rotor_count() as f64;
    // e_z x
    Vector3::new(-flow_m_s.y, flow_m_s.x, 0.0)
}

impl Effect for BladeFlapping {
    fn id(&self) -> &'static str {
        "blade_flapping"
    }

    fn sentence(&self) -> &'static str {
        "The blades flap: a torque about the horizontal axes in proportion to the airspeed."
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

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        sum.torque_nm += per_coefficient(at, rotors) * own.parameters[0];
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = Wrench { force_n: Vector3::zeros(), torque_nm: per_coefficient(at, rotors) };
        }
    }
}
