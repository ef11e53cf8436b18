//! Near the ground a rotor gives more thrust.

use nalgebra::Vector3;

use crate::physics::{Airframe, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

/// Thrust of the rotor at height z over the ground (world z = 0) times
/// `1 / (1 - rho (R / 4z)^2) + Ca exp(-Cb z / R)`. With Ca = 0 the form of Cheeseman and Bennett 1955 (rho = 1
/// for one rotor, more for several), with rho = 0 the exponential form; an estimate holds one of them at
/// zero. z is the height of the centre of mass plus `levelling` times the hub's height over it: with 1 the lower
/// rotors of a banked vehicle are lifted more and it levels out, with 0 all are lifted alike; flow between the
/// rotors makes it anything in between. The reaction torque stays, since the rotor's speed and drag do.
///
/// Sanchez-Cuevas et al. 2017 (10.1155/2017/1823056) measured two to four times the first form.
#[derive(Debug, Clone, Copy)]
pub struct GroundEffect;

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "rho", unit: "-", min: 0.0, max: 8.0 },
    Parameter { name: "ca", unit: "-", min: 0.0, max: 1.0 },
    Parameter { name: "cb", unit: "-", min: 0.2, max: 8.0 },
    Parameter { name: "levelling", unit: "-", min: 0.0, max: 1.0 },
];

/// Lower than this no rotor turns over the ground; it also keeps the first form from its pole.
const LEAST_RADII: f64 = 0.75;

/// Height of a hub over the ground that counts, in rotor radii.
fn height_in_radii(at: &Condition, arm: &Vector3<f64>, levelling: f64) -> f64 {
    let radius_m = at.airframe.propulsion.rotor_radius_m.unwrap_or(f64::INFINITY);
    let height_m = at.state.position_m.z + levelling * hub_over_center_m(at, arm);
    (height_m / radius_m).max(LEAST_RADII)
}

/// World, m.
fn hub_over_center_m(at: &Condition, arm: &Vector3<f64>) -> f64 {
    at.height_of(arm) - at.state.position_m.z
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

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn missing(&self, airframe: &Airframe) -> Option<&'static str> {
        airframe.propulsion.rotor_radius_m.is_none().then_some("rotor_radius")
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own) -> Wrench {
        let [rho, ca, cb, levelling] = [0, 1, 2, 3].map(|index| own.parameters[index]);
        let mut sum = Wrench::zero();
        for (arm, thrust_n) in at.arms_m().zip(&rotors.thrust_n) {
            let radii = height_in_radii(at, &arm, levelling);
            let gain = cheeseman_bennett(rho, radii) - 1.0 + ca * (-cb * radii).exp();
            sum += Wrench::at(&arm, Vector3::z() * (thrust_n * gain));
        }
        sum
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [rho, ca, cb, levelling] = [0, 1, 2, 3].map(|index| parameters[index]);
        let [by_rho, by_ca, by_cb, by_levelling] = columns else { return };
        for column in [&mut *by_rho, &mut *by_ca, &mut *by_cb, &mut *by_levelling] {
            *column = Wrench::zero();
        }
        let radius_m = at.airframe.propulsion.rotor_radius_m.unwrap_or(f64::INFINITY);
        for (arm, thrust_n) in at.arms_m().zip(&rotors.thrust_n) {
            let radii = height_in_radii(at, &arm, levelling);
            let lift = |gain: f64| Wrench::at(&arm, Vector3::z() * (thrust_n * gain));
            let share = cheeseman_bennett(rho, radii);
            *by_rho += lift(share * share / (16.0 * radii * radii));
            let decay = (-cb * radii).exp();
            *by_ca += lift(decay);
            *by_cb += lift(-ca * radii * decay);
            if radii > LEAST_RADII {
                let slope = -share * share * rho / (8.0 * radii.powi(3)) - ca * cb * decay;
                *by_levelling += lift(slope * hub_over_center_m(at, &arm) / radius_m);
            }
        }
    }
}
