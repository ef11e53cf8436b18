//! The thrust axis leans in the body.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `F_i = T_i (b_y, -b_x, 0)` at each hub in addition to the thrust: the rotor plane is turned by the small angles
    /// `b_x` = `x` and `b_y` = `y` about the axes of the body.
    #[derive(Debug, Clone, Copy)]
    pub struct ThrustTilt;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
    Parameter { name: "y", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
];

/// Each rotor's thrust along `lean` at its hub.
fn across(at: &Condition, rotors: &Rotors, lean: &Vector3<f64>) -> Wrench {
    let mut sum = Wrench::zero();
    for (arm, thrust_n) in at.arms_m().iter().zip(&rotors.thrust_n) {
        sum.push_at(arm, &(lean * *thrust_n));
    }
    sum
}

impl Effect for ThrustTilt {
    fn id(&self) -> &'static str {
        "thrust_tilt"
    }

    fn sentence(&self) -> &'static str {
        "The thrust axis is tilted: the thrust has a sideways component that is fixed in the body."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn sided(&self) -> &'static [usize] {
        &[0]
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let lean = Vector3::new(own.parameters[1], -own.parameters[0], 0.0);
        *sum += across(at, rotors, &lean);
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        let [by_x, by_y] = columns else { return };
        *by_x = across(at, rotors, &-Vector3::y());
        *by_y = across(at, rotors, &Vector3::x());
    }
}
