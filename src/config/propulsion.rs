//! From commands to thrust and torque, as the file states it.

use super::check::Check;
use super::faults::Faults;
use super::vehicle_file::{ActuatorKind, PropulsionTable};
use crate::vehicle::{Actuator, Propulsion, PwmRange, ThrustLaw};

pub(super) fn propulsion(check: &Check<'_>, table: &PropulsionTable, faults: &mut Faults) -> Propulsion {
    if let (Some(speed), Some(thrust)) = (table.speed_max, table.thrust_max) {
        let expected = "either speed_max (with thrust_coefficient) or thrust_max (with thrust_expo)";
        let came = format!("speed_max = {speed} and thrust_max = {thrust}");
        faults.check(Err(check.refuse("propulsion", expected, came)));
    }
    let by_speed = match table.actuator {
        ActuatorKind::Speed => true,
        ActuatorKind::Thrust => false,
        ActuatorKind::Pwm => table.speed_max.is_some(),
    };
    let kind_unknown = faults.stands_in("propulsion.actuator");
    let unknown = kind_unknown || (table.speed_max.is_some() && table.thrust_max.is_some());
    let (law, thrust_coefficient, torque_per_thrust_m) = match (unknown, by_speed) {
        // which law is meant is not known, so what belongs to it is not either
        (true, _) => (ThrustLaw::Speed { speed_max_rad_s: f64::NAN }, None, f64::NAN),
        (false, true) => speed_law(check, table, faults),
        (false, false) => curve_law(check, table, faults),
    };
    let time_constant =
        table.time_constant.map(|value| check.not_negative("propulsion.time_constant", value));
    Propulsion {
        actuator: if kind_unknown { Actuator::Thrust } else { actuator(check, table, faults) },
        law,
        thrust_coefficient,
        torque_per_thrust_m,
        rotor_radius_m: faults
            .optional(check.optional_positive("propulsion.rotor_radius", table.rotor_radius)),
        time_constant_s: faults.optional(time_constant.transpose()),
        time_constant_down_s: falling_time_constant(check, table, faults),
    }
}

/// The time constant of rotors that slow down, s. It needs that of rotors that speed up.
fn falling_time_constant(check: &Check<'_>, table: &PropulsionTable, faults: &mut Faults) -> Option<f64> {
    let because = "time_constant_down is that of falling speed beside that of rising speed";
    if table.time_constant_down.is_some() {
        faults.number(check.required("propulsion.time_constant", table.time_constant, because));
    }
    faults.optional(check.optional_positive("propulsion.time_constant_down", table.time_constant_down))
}

/// Law, thrust coefficient, torque per thrust.
type Law = (ThrustLaw, Option<f64>, f64);

fn speed_law(check: &Check<'_>, table: &PropulsionTable, faults: &mut Faults) -> Law {
    let because = "the thrust is thrust_coefficient * (u * speed_max)^2";
    let mut positive = |key: &str, value| {
        faults.number(check.required(key, value, because).and_then(|value| check.positive(key, value)))
    };
    let speed_max_rad_s = positive("propulsion.speed_max", table.speed_max);
    let coefficient = positive("propulsion.thrust_coefficient", table.thrust_coefficient);
    let key = "propulsion.torque_coefficient";
    let torque = check.required(key, table.torque_coefficient, because);
    let torque = faults.number(torque.and_then(|torque| check.not_negative(key, torque)));
    for (key, value) in [
        ("propulsion.thrust_max", table.thrust_max),
        ("propulsion.thrust_expo", table.thrust_expo),
        ("propulsion.torque_ratio", table.torque_ratio),
    ] {
        faults.check(check.absent(key, value, because));
    }
    (ThrustLaw::Speed { speed_max_rad_s }, Some(coefficient), torque / coefficient)
}

fn curve_law(check: &Check<'_>, table: &PropulsionTable, faults: &mut Faults) -> Law {
    let because = "the thrust is thrust_max * ((1 - thrust_expo) * u + thrust_expo * u^2)";
    for (key, value) in [
        ("propulsion.speed_max", table.speed_max),
        ("propulsion.torque_coefficient", table.torque_coefficient),
    ] {
        faults.check(check.absent(key, value, because));
    }
    let required = |key: &str, value| check.required(key, value, because);
    let key = "propulsion.thrust_max";
    let thrust_max = required(key, table.thrust_max).and_then(|value| check.positive(key, value));
    let key = "propulsion.thrust_expo";
    let expo = required(key, table.thrust_expo).and_then(|value| check.finite(key, value));
    let expo = expo.and_then(|expo| match expo {
        0.0..=1.0 => Ok(expo),
        _ => Err(check.refuse(key, "a number from 0 (linear) to 1 (quadratic)", expo)),
    });
    let key = "propulsion.torque_ratio";
    let torque_ratio = required(key, table.torque_ratio).and_then(|value| check.not_negative(key, value));
    let coefficient = check.optional_positive("propulsion.thrust_coefficient", table.thrust_coefficient);
    let law = ThrustLaw::Curve { thrust_max_n: faults.number(thrust_max), expo: faults.number(expo) };
    let torque_ratio_m = faults.number(torque_ratio);
    (law, faults.optional(coefficient), torque_ratio_m)
}

fn actuator(check: &Check<'_>, table: &PropulsionTable, faults: &mut Faults) -> Actuator {
    let ends = [("propulsion.pwm_min", table.pwm_min), ("propulsion.pwm_max", table.pwm_max)];
    let other = match table.actuator {
        ActuatorKind::Speed => Actuator::Speed,
        ActuatorKind::Thrust => Actuator::Thrust,
        // without a range the recorded values are fractions of full scale, which only the speed law may leave out: with the
        // curve law, fractions are `actuator = "thrust"`
        ActuatorKind::Pwm if ends.iter().all(|(_, end)| end.is_none()) && table.speed_max.is_some() => {
            return Actuator::Pwm(None);
        }
        ActuatorKind::Pwm => {
            let because =
                "pulse widths need both ends of their range (for values 0..1 use actuator = \"thrust\")";
            let [min_us, max_us] = ends.map(|(key, end)| {
                faults.number(check.required(key, end, because).and_then(|end| check.finite(key, end)))
            });
            faults.check(check.ordered((ends[0].0, Some(min_us)), (ends[1].0, Some(max_us))));
            return Actuator::Pwm(Some(PwmRange { min_us, max_us }));
        }
    };
    for (key, end) in ends {
        faults.check(check.absent(key, end, "`propulsion.actuator` is not \"pwm\""));
    }
    other
}
