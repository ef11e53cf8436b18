//! Thrust does not follow the law that the vehicle file states.

use crate::physics::{Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

/// `T_i = T (1 + c x + e x^2)` with `x = T / T_hover - 1`: nothing at hover, where the scale is known, and a slope there
/// of `1 + c` times that of the law; reaction torque alike. In the finer form the curve has a `bow` e of its own.
///
/// PX4's THR_MDL_FAC and ArduPilot's MOT_THST_EXPO are other forms of this curve: thrust with a share f of the square of
/// the speed and `1 - f` of the speed itself is `c = -(1 - f) / 2` and, to this order, `e = -3 c / 4`.
#[derive(Debug, Clone, Copy)]
pub struct ThrustCurve;

const PARAMETERS: &[Parameter] = &[Parameter { name: "curvature", unit: "-", min: -0.5, max: 0.5 }];
const FINER: &[Parameter] = &[Parameter { name: "bow", unit: "-", min: -1.0, max: 1.0 }];

/// Thrust beyond that of hover, as a share of it (-).
fn beyond_hover(at: &Condition, thrust_n: f64) -> f64 {
    thrust_n / at.airframe.hover_thrust_n - 1.0
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

    fn finer_parameters(&self) -> &'static [Parameter] {
        FINER
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::RotorThrust]
    }

    fn rotor_thrust(&self, at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        let bow = own.parameters.get(PARAMETERS.len()).copied().unwrap_or(0.0);
        for thrust_n in &mut rotors.thrust_n {
            let x = beyond_hover(at, *thrust_n);
            *thrust_n *= 1.0 + (own.parameters[0] + bow * x) * x;
        }
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            let bent_n = rotors.thrust_n.map(|thrust_n| thrust_n * beyond_hover(at, thrust_n));
            *column = at.thrust_wrench(&bent_n);
        }
    }
}
