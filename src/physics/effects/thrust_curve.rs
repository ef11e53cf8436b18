//! Thrust does not follow the law that the vehicle file states.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `T_i = T + 2 T_hover s (s - 1) (c + e (s - 1))` with `s = sqrt(T / T_hover)`, the speed that the thrust law gives
    /// over that of hover, and c the `curvature`. Nothing changes at hover, where the scale is known. The slope there is
    /// `1 + c` times that of the law. The reaction torque changes by the same factor. In the finer form the curve has in
    /// addition a `bow` e.
    ///
    /// A thrust with a share f of the square of the command and `1 - f` of the command itself, as PX4's THR_MDL_FAC and
    /// ArduPilot's MOT_THST_EXPO have it, corresponds to `c = (f - 1) / 2` of a law with the square alone (f for commands
    /// relative to hover).
    #[derive(Debug, Clone, Copy)]
    pub struct ThrustCurve;
}

const PARAMETERS: &[Parameter] = &[Parameter { name: "curvature", unit: "-", bounds: Bounds::of(-0.5, 0.5) }];
const FINER: &[Parameter] = &[Parameter { name: "bow", unit: "-", bounds: Bounds::of(-1.0, 1.0) }];

/// Change of a rotor's thrust for one unit of curvature, N, and of bow.
fn bend_n(at: &Condition, thrust_n: f64) -> (f64, f64) {
    let hover_n = at.airframe.hover_thrust_n;
    let speed = (thrust_n / hover_n).max(0.0).sqrt();
    let bent_n = 2.0 * hover_n * speed * (speed - 1.0);
    (bent_n, bent_n * (speed - 1.0))
}

impl Effect for ThrustCurve {
    fn id(&self) -> &'static str {
        "thrust_curve"
    }

    fn sentence(&self) -> &'static str {
        "The thrust curve is bent: thrust grows faster or slower with the command than stated."
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
        &[Hook::RotorThrust]
    }

    fn rotor_thrust(&self, at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        let bow = own.parameters.get(PARAMETERS.len()).copied().unwrap_or(0.0);
        for thrust_n in &mut rotors.thrust_n {
            let (by_curvature_n, by_bow_n) = bend_n(at, *thrust_n);
            *thrust_n += own.parameters[0] * by_curvature_n + bow * by_bow_n;
        }
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = at.thrust_wrench(&rotors.thrust_n.map(|thrust_n| bend_n(at, thrust_n).0));
        }
    }
}
