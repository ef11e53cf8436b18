//! Thrust falls with the battery's voltage.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `T_i = T (V / V_full)^exponent`. The reaction torque changes by the same factor, because the rotors turn slower by
    /// its square root. Nothing changes where the voltage is unknown or the rotor speeds are measured. The exponent is 2
    /// if the speed is proportional to the voltage, and 0 if the ESC controls the speed.
    #[derive(Debug, Clone, Copy)]
    pub struct BatterySag;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "exponent", unit: "-", bounds: Bounds::of(0.0, 4.0) },
    Parameter { name: "full_voltage", unit: "V", bounds: Bounds::of(2.5, 60.0) },
];

/// V / V_full; 1 where the voltage is not known or not positive.
fn ratio(at: &Condition, parameters: &[f64]) -> f64 {
    at.input.battery_voltage_v.filter(|voltage_v| *voltage_v > 0.0).map_or(1.0, |now_v| now_v / parameters[1])
}

impl Effect for BatterySag {
    fn id(&self) -> &'static str {
        "battery_sag"
    }

    fn sentence(&self) -> &'static str {
        "Thrust falls with the battery: the same command gives less as its voltage drops."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::RotorSpeed]
    }

    fn rotor_speed(&self, at: &Condition, own: &mut Own, rotors: &mut Rotors) {
        let factor = ratio(at, own.parameters).powf(own.parameters[0] / 2.0);
        for speed in rotors.speed.iter_mut().chain(&mut rotors.acceleration_1_s) {
            *speed *= factor;
        }
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [by_exponent, by_voltage] = columns else { return };
        let (ratio, exponent) = (ratio(at, parameters), parameters[0]);
        let sagged = at.thrust_wrench(&rotors.thrust_n) * ratio.powf(exponent);
        *by_exponent = sagged * ratio.ln();
        let known = at.input.battery_voltage_v.is_some();
        *by_voltage = sagged * if known { -exponent / parameters[1] } else { 0.0 };
    }
}
