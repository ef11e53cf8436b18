//! The quantities beside mass and inertia that one may want to know of a vehicle, and the effects that they belong to.

use super::{battery_sag, com_offset, linear_drag, motor_lag, steady_wind, thrust_curve, weak_rotor};
use crate::diagnose::signature::Signature;
use crate::vehicle::Vehicle;

/// A quantity that one may want to know.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// as in documents
    pub name: &'static str,
    /// the effect whose size it is
    pub signature: &'static Signature,
    /// size on ordinary vehicles, in the unit of the effect's first amount
    pub usual: fn(&Vehicle) -> f64,
}

/// Lag of small motors with propellers, s. Chosen; not measured.
const LAG_S: f64 = 0.03;
/// A light breeze, m/s. Chosen; not measured.
const BREEZE_M_S: f64 = 2.0;
/// Offset of the centre of mass over the distance of the rotors, as a battery that slipped brings it. Chosen; not measured.
const OFFSET_OF_ARM: f64 = 0.05;
/// Difference of one rotor's thrust that is ordinary (-). Chosen; not measured.
const ROTOR: f64 = 0.08;
/// Thrust goes with the square of the speed, and the speed with the voltage, unless the autopilot corrects it (-).
const EXPONENT: f64 = 1.5;

/// All of them, in the order of the page.
pub static WANTED: &[Wanted] = &[
    Wanted {
        name: "thrust_curve",
        signature: &thrust_curve::SIGNATURE,
        usual: |vehicle| stated(&thrust_curve::SIGNATURE, vehicle),
    },
    Wanted { name: "motor_lag", signature: &motor_lag::SIGNATURE, usual: |_| LAG_S },
    Wanted {
        name: "drag",
        signature: &linear_drag::SIGNATURE,
        usual: |vehicle| stated(&linear_drag::SIGNATURE, vehicle),
    },
    Wanted { name: "wind", signature: &steady_wind::SIGNATURE, usual: |_| BREEZE_M_S },
    Wanted { name: "centre_of_mass", signature: &com_offset::SIGNATURE, usual: offset_m },
    Wanted { name: "rotor_efficiency", signature: &weak_rotor::SIGNATURE, usual: |_| ROTOR },
    Wanted { name: "voltage_sag", signature: &battery_sag::SIGNATURE, usual: |_| EXPONENT },
];

/// The size that the signature states for its first amount; nought where it states none.
fn stated(signature: &Signature, vehicle: &Vehicle) -> f64 {
    let first = signature.effect.parameters().first();
    first.and_then(|parameter| (signature.naming.usual)(parameter.name, vehicle)).unwrap_or(0.0)
}

fn offset_m(vehicle: &Vehicle) -> f64 {
    let arms = vehicle.rotors.iter().map(|rotor| rotor.position_m.xy().norm());
    OFFSET_OF_ARM * arms.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::random_vehicle;

    #[test]
    fn every_quantity_has_a_usual_size_on_any_vehicle() {
        for seed in 0..20 {
            let vehicle = random_vehicle(seed).nominal;
            for wanted in WANTED {
                let usual = (wanted.usual)(&vehicle);
                assert!(usual > 0.0 && usual.is_finite(), "{}: {usual}", wanted.name);
            }
        }
    }
}
