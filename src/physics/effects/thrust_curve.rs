//! Thrust does not follow the law that the vehicle file states.

use crate::physics::{Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

/// `T_i = T (1 + c (T / T_hover - 1))`: nothing at hover, where the scale is known, and a slope there of `1 + c`
/// times that of the law; reaction torque alike.
///
/// PX4's THR_MDL_FAC and ArduPilot's MOT_THST_EXPO are other forms of this curve.
#[derive(Debug, Clone, Copy)]
pub struct ThrustCurve;

const PARAMETERS: &[Parameter] = &[Parameter { name: "curvature", unit: "-", min: -0.5, max: 0.5 }];

/// Change of a rotor's thrust for one unit of curvature, N.
fn bend_n(at: &Condition, thrust_n: f64) -> f64 {
    thrust_n * (thrust_n / at.airframe.hover_thrust_n - 1.0)
}

impl Effect for ThrustCurve {
    fn id(&self) -> &'static str {
        "thrust_curve"
    }

    fn sentence(&self) -> &'static str {
        "The thrust curve is bent: thrust grows faster or slower with the command than stated."
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::RotorThrust]
    }

    fn rotor_thrust(&self, at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        for thrust_n in &mut rotors.thrust_n {
            *thrust_n += own.parameters[0] * bend_n(at, *thrust_n);
        }
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = at.thrust_wrench(&rotors.thrust_n.map(|thrust_n| bend_n(at, thrust_n)));
        }
    }
}
