//! The quantities beside mass and inertia that one may want to know of a vehicle, and the effects that they belong to.

use super::{battery_sag, com_offset, linear_drag, motor_lag, steady_wind, thrust_curve, weak_rotor};
use crate::diagnose::signature::Signature;
use crate::vehicle::Vehicle;

/// A quantity that one may want to know.
#[derive(Debug, Clone, Copy)]
pub struct EffectQuantity {
    /// as in documents
    pub name: &'static str,
    /// the effect whose size it is
    pub signature: &'static Signature,
    /// size on ordinary vehicles, in the unit of the effect's first amount
    pub usual: fn(&Vehicle) -> f64,
    /// the part of a recording that determines it
    pub determined_by: DeterminedBy,
    /// what to fly for more of it
    pub fly: &'static str,
}

/// The part of a recording that determines a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeterminedBy {
    /// torques, as the vehicle turns
    Torques,
    /// the mean of torques that act always
    MeanTorques,
    /// torques and the force along the thrust
    Forces,
    /// the same over the velocity
    ForcesOverVelocity,
    /// the same over the battery's voltage
    ForcesOverVoltage,
}

/// Lag of small motors with propellers, s. It only scales what `inspect` calls a usual effect.
const LAG_S: f64 = 0.03;
/// A light breeze, m/s. It only scales what `inspect` calls a usual effect.
const BREEZE_M_S: f64 = 2.0;
/// Offset of the centre of mass over the distance of the rotors, as a battery that slipped brings it. It only scales
/// what `inspect` calls a usual effect.
const OFFSET_OF_ARM: f64 = 0.05;
/// Difference of one rotor's thrust that is ordinary (-). It only scales what `inspect` calls a usual effect.
const ROTOR: f64 = 0.08;
/// Thrust goes with the square of the speed, and the speed with the voltage, unless the autopilot corrects it (-).
const EXPONENT: f64 = 1.5;

/// What tells the balance of a vehicle.
const LONG_AND_CALM: &str = "30 s and more with climbs, in calm air";

/// All of them, in the order of the page.
pub static EFFECT_QUANTITIES: &[EffectQuantity] = &[
    EffectQuantity {
        name: "thrust_curve",
        signature: &thrust_curve::SIGNATURE,
        usual: |vehicle| stated(&thrust_curve::SIGNATURE, vehicle),
        determined_by: DeterminedBy::Forces,
        fly: "climbs and descents, hard ones too",
    },
    EffectQuantity {
        name: "motor_lag",
        signature: &motor_lag::SIGNATURE,
        usual: |_| LAG_S,
        determined_by: DeterminedBy::Torques,
        fly: "quick turns about all axes",
    },
    EffectQuantity {
        name: "drag",
        signature: &linear_drag::SIGNATURE,
        usual: |vehicle| stated(&linear_drag::SIGNATURE, vehicle),
        determined_by: DeterminedBy::ForcesOverVelocity,
        fly: "legs there and back at 5 m/s and more",
    },
    EffectQuantity {
        name: "wind",
        signature: &steady_wind::SIGNATURE,
        usual: |_| BREEZE_M_S,
        determined_by: DeterminedBy::ForcesOverVelocity,
        fly: "legs in several directions at 3 m/s and more",
    },
    EffectQuantity {
        name: "centre_of_mass",
        signature: &com_offset::SIGNATURE,
        usual: offset_m,
        determined_by: DeterminedBy::MeanTorques,
        fly: LONG_AND_CALM,
    },
    EffectQuantity {
        name: "rotor_efficiency",
        signature: &weak_rotor::SIGNATURE,
        usual: |_| ROTOR,
        determined_by: DeterminedBy::MeanTorques,
        fly: LONG_AND_CALM,
    },
    EffectQuantity {
        name: "voltage_sag",
        signature: &battery_sag::SIGNATURE,
        usual: |_| EXPONENT,
        determined_by: DeterminedBy::ForcesOverVoltage,
        fly: "until the battery has lost a tenth of its voltage",
    },
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
            for quantity in EFFECT_QUANTITIES {
                let usual = (quantity.usual)(&vehicle);
                assert!(usual > 0.0 && usual.is_finite(), "{}: {usual}", quantity.name);
            }
        }
    }
}
