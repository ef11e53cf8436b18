//! From the checked vehicle back to its file.

use super::ConfigError;
use super::check::Check;
use super::faults::Faults;
use super::rigid_body::rigid_body;
use super::vehicle_file::{
    ActuatorKind, AnchorKey, BodyTable, FORMAT, GuessTable, IdentifyTable, InertiaTable, LimitsTable,
    PropulsionTable, RotorTable, SpinKey, VehicleFile,
};
use crate::units;
use crate::vehicle::{Actuator, Anchor, Guess, Limits, Propulsion, Rotor, Spin, ThrustLaw, Vehicle};

/// Names what is refused. A part of an inertia that a flight determined need not fit the nominal rest.
const WRITTEN: &str =
    "the vehicle to be written (what the flight did not determine is as in the vehicle file)";

/// The vehicle in the form of `vehicle.toml`. More tables may be appended as text: it ends in a newline.
///
/// # Errors
/// [`ConfigError::Write`] where a value has no form in TOML; [`ConfigError::Invalid`] where mass and inertia are no body's, so
/// that the file could not be read again.
pub fn vehicle_to_toml(vehicle: &Vehicle) -> Result<String, ConfigError> {
    let inertia = &vehicle.body.inertia_kg_m2;
    let file = VehicleFile {
        format: FORMAT,
        name: vehicle.name.clone(),
        body: BodyTable {
            mass: vehicle.body.mass_kg,
            center_of_mass: vehicle.body.center_of_mass_m.into(),
            gravity: Some(vehicle.gravity_m_s2),
            gyroscopic: Some(vehicle.body.gyroscopic).filter(|share| *share != 1.0),
            inertia: InertiaTable {
                xx: inertia.m11,
                yy: inertia.m22,
                zz: inertia.m33,
                xy: inertia.m12,
                xz: inertia.m13,
                yz: inertia.m23,
            },
        },
        propulsion: propulsion_table(&vehicle.propulsion),
        rotors: vehicle.rotors.iter().map(rotor_table).collect(),
        limits: limits_table(&vehicle.limits),
        identify: IdentifyTable {
            anchor: match vehicle.anchor {
                Anchor::Thrust => AnchorKey::Thrust,
                Anchor::Mass => AnchorKey::Mass,
            },
        },
        guesses: vehicle.guesses.iter().map(guess_table).collect(),
        identified: None,
        provenance: None,
        effects: Vec::new(),
    };
    let mut faults = Faults::default();
    rigid_body(&Check { origin: WRITTEN }, &file.body, &mut faults);
    faults.refuse(WRITTEN)?;
    Ok(toml::to_string(&file)?)
}

fn guess_table(guess: &Guess) -> GuessTable {
    GuessTable { of: guess.of.name().to_owned(), relative_std: guess.relative, why: guess.why.clone() }
}

fn rotor_table(rotor: &Rotor) -> RotorTable {
    RotorTable {
        name: rotor.name.clone(),
        position: rotor.position_m.into(),
        spin: match rotor.spin {
            Spin::Cw => SpinKey::Cw,
            Spin::Ccw => SpinKey::Ccw,
        },
    }
}

fn propulsion_table(propulsion: &Propulsion) -> PropulsionTable {
    let (actuator, range) = match propulsion.actuator {
        Actuator::Speed => (ActuatorKind::Speed, None),
        Actuator::Thrust => (ActuatorKind::Thrust, None),
        Actuator::Pwm(range) => (ActuatorKind::Pwm, range),
    };
    let ratio = propulsion.torque_per_thrust_m;
    let mut table = PropulsionTable {
        actuator,
        pwm_min: range.map(|range| range.min_us),
        pwm_max: range.map(|range| range.max_us),
        speed_max: None,
        thrust_coefficient: propulsion.thrust_coefficient,
        torque_coefficient: None,
        thrust_max: None,
        thrust_expo: None,
        torque_ratio: None,
        rotor_radius: propulsion.rotor_radius_m,
        time_constant: propulsion.time_constant_s,
        time_constant_down: propulsion.time_constant_down_s,
    };
    match propulsion.law {
        ThrustLaw::Speed { speed_max_rad_s } => {
            table.speed_max = Some(speed_max_rad_s);
            table.torque_coefficient = propulsion.thrust_coefficient.map(|k| k * ratio);
        }
        ThrustLaw::Curve { thrust_max_n, expo } => {
            table.thrust_max = Some(thrust_max_n);
            table.thrust_expo = Some(expo);
            table.torque_ratio = Some(ratio);
        }
    }
    table
}

pub(super) fn limits_table(limits: &Limits) -> LimitsTable {
    let degrees = |rad: Option<f64>| rad.map(units::deg_from_rad);
    LimitsTable {
        roll_max_deg: degrees(limits.roll_max_rad),
        pitch_max_deg: degrees(limits.pitch_max_rad),
        yaw_max_deg: degrees(limits.yaw_max_rad),
        yaw_rate_max_deg_s: degrees(limits.yaw_rate_max_rad_s),
        yaw_acceleration_max_deg_s2: degrees(limits.yaw_acceleration_max_rad_s2),
        x_max_m: limits.x_max_m,
        y_max_m: limits.y_max_m,
        z_min_m: limits.z_min_m,
        z_max_m: limits.z_max_m,
        speed_max_m_s: limits.speed_max_m_s,
        acceleration_max_m_s2: limits.acceleration_max_m_s2,
        vertical_acceleration_min_m_s2: limits.vertical_acceleration_min_m_s2,
        vertical_acceleration_max_m_s2: limits.vertical_acceleration_max_m_s2,
        thrust_max_n: limits.thrust_max_n,
        torque_max_nm: limits.torque_max_nm,
    }
}
