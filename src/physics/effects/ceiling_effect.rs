//! Under a ceiling a rotor gives more thrust.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// The thrust of a rotor is multiplied by `1 / (1 - (1/a1) (R / (z + a2))^2)`, where z is its distance below a
    /// ceiling at `height` over the ground.
    ///
    /// Sanchez-Cuevas et al. 2017.
    #[derive(Debug, Clone, Copy)]
    pub struct CeilingEffect;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "a1", unit: "-", bounds: Bounds::of(2.0, 50.0) },
    Parameter { name: "a2", unit: "m", bounds: Bounds::of(0.0, 1.0).by_arm(1) },
    Parameter { name: "height", unit: "m", bounds: Bounds::of(0.5, 50.0) },
];

/// Closer than this no rotor gets, in radii; it keeps the factor from its pole.
const LEAST_RADII: f64 = 1.0;

/// How near a rotor is to the ceiling.
struct Nearness {
    /// `(R / (z + a2))^2`
    squared: f64,
    /// `z + a2`, m
    distance_m: f64,
    /// z is at its least
    held: bool,
}

fn nearness(at: &Condition, arm: &Vector3<f64>, parameters: &[f64]) -> Nearness {
    let radius_m = at.airframe.propulsion.rotor_radius_m.unwrap_or(0.0);
    let (below_m, least_m) = (parameters[2] - at.height_of(arm), LEAST_RADII * radius_m);
    let distance_m = below_m.max(least_m) + parameters[1];
    Nearness { squared: (radius_m / distance_m).powi(2), distance_m, held: below_m < least_m }
}

impl Effect for CeilingEffect {
    fn id(&self) -> &'static str {
        "ceiling_effect"
    }

    fn sentence(&self) -> &'static str {
        "A ceiling is near: the rotors give more thrust the closer they are to it."
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

    fn missing(&self, airframe: &Airframe) -> Option<&'static str> {
        airframe.propulsion.rotor_radius_m.is_none().then_some("rotor_radius")
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        for (arm, thrust_n) in at.arms_m().iter().zip(&rotors.thrust_n) {
            let near = nearness(at, arm, own.parameters);
            let gain = 1.0 / (1.0 - near.squared / own.parameters[0]) - 1.0;
            sum.lift_at(arm, thrust_n * gain);
        }
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let a1 = parameters[0];
        let [by_a1, by_a2, by_height] = columns else { return };
        (*by_a1, *by_a2, *by_height) = (Wrench::zero(), Wrench::zero(), Wrench::zero());
        for (arm, thrust_n) in at.arms_m().iter().zip(&rotors.thrust_n) {
            let near = nearness(at, arm, parameters);
            let factor = 1.0 / (1.0 - near.squared / a1);
            let scale_n = thrust_n * factor * factor * near.squared / a1;
            by_a1.lift_at(arm, -scale_n / a1);
            let slope_n_m = -2.0 * scale_n / near.distance_m;
            by_a2.lift_at(arm, slope_n_m);
            by_height.lift_at(arm, if near.held { 0.0 } else { slope_n_m });
        }
    }
}
