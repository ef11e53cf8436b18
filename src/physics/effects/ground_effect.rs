//! Near the ground a rotor gives more thrust.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// The thrust of a rotor at height z over the ground (world z = 0) is multiplied by
    /// `1 / (1 - rho (R / 4z)^2) + Ca exp(-Cb z / R)`. With Ca = 0 this is the form of Cheeseman and Bennett 1955 (rho =
    /// 1 for one rotor, more for several). With rho = 0 it is the exponential form. An estimate holds one of them at
    /// zero. In the finer form, z is the height of the centre of mass plus `levelling` times the height of the hub over
    /// it. With 1, as without the finer form, the lower rotors of a banked vehicle are lifted more, and the vehicle
    /// levels out. With 0 all rotors are lifted equally. Flow between the rotors causes values in between. The reaction
    /// torque is unchanged, because speed and drag of the rotor are.
    ///
    /// Sanchez-Cuevas et al. 2017 (10.1155/2017/1823056) measured two to four times the first form.
    #[derive(Debug, Clone, Copy)]
    pub struct GroundEffect;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "rho", unit: "-", bounds: Bounds::of(0.0, 8.0) },
    Parameter { name: "ca", unit: "-", bounds: Bounds::of(0.0, 1.0) },
    Parameter { name: "cb", unit: "-", bounds: Bounds::of(0.2, 8.0) },
];

const FINER: &[Parameter] = &[Parameter { name: "levelling", unit: "-", bounds: Bounds::of(0.0, 1.0) }];

impl GroundEffect {
    /// Lower than this, in rotor radii, no rotor turns over the ground; it also keeps the first form from its pole.
    pub const LEAST_RADII: f64 = 0.75;
}

/// Height over the ground that counts for a hub, in rotor radii.
fn height_in_radii(at: &Condition, arm: &Vector3<f64>, parameters: &[f64]) -> f64 {
    let radius_m = at.airframe.propulsion.rotor_radius_m.unwrap_or(f64::INFINITY);
    let levelling = parameters.get(PARAMETERS.len()).copied().unwrap_or(1.0);
    let over_center_m = at.height_of(arm) - at.state.position_m.z;
    ((at.state.position_m.z + levelling * over_center_m) / radius_m).max(GroundEffect::LEAST_RADII)
}

/// Factor on thrust.
fn cheeseman_bennett(rho: f64, radii: f64) -> f64 {
    1.0 / (1.0 - rho / (16.0 * radii * radii))
}

impl Effect for GroundEffect {
    fn id(&self) -> &'static str {
        "ground_effect"
    }

    fn sentence(&self) -> &'static str {
        "The ground is near: the rotors give more thrust the lower they are."
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

    fn missing(&self, airframe: &Airframe) -> Option<&'static str> {
        airframe.propulsion.rotor_radius_m.is_none().then_some("rotor_radius")
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let [rho, ca, cb] = [own.parameters[0], own.parameters[1], own.parameters[2]];
        for (arm, thrust_n) in at.arms_m().iter().zip(&rotors.thrust_n) {
            let radii = height_in_radii(at, arm, own.parameters);
            let gain = cheeseman_bennett(rho, radii) - 1.0 + ca * (-cb * radii).exp();
            sum.lift_at(arm, thrust_n * gain);
        }
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [rho, ca, cb] = [parameters[0], parameters[1], parameters[2]];
        let [by_rho, by_ca, by_cb, ..] = columns else { return };
        (*by_rho, *by_ca, *by_cb) = (Wrench::zero(), Wrench::zero(), Wrench::zero());
        for (arm, thrust_n) in at.arms_m().iter().zip(&rotors.thrust_n) {
            let radii = height_in_radii(at, arm, parameters);
            let share = cheeseman_bennett(rho, radii);
            by_rho.lift_at(arm, thrust_n * share * share / (16.0 * radii * radii));
            let decay = (-cb * radii).exp();
            by_ca.lift_at(arm, thrust_n * decay);
            by_cb.lift_at(arm, -thrust_n * ca * radii * decay);
        }
    }
}
