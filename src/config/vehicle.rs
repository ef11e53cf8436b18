//! From the written vehicle to the checked one, and back.

use std::collections::BTreeSet;
use std::path::Path;

use super::ConfigError;
use super::check::Check;
use super::kind::Kind;
use super::plausible::warnings;
use super::read::{parse_toml, read_text};
use super::rigid_body::rigid_body;
use super::vehicle_file::{
    ActuatorKind, AnchorKey, FORMAT, GuessTable, LimitsTable, PropulsionTable, RotorTable, SpinKey,
    VehicleFile,
};
use crate::text;
use crate::units;
use crate::vehicle::{
    Actuator, Anchor, Guess, Guessed, Limits, Propulsion, PwmRange, Rotor, Spin, ThrustLaw, Vehicle,
};

/// Rotors of a vehicle: as many as MAVLink has outputs for (ACTUATOR_OUTPUT_STATUS).
const ROTORS_MAX: usize = 32;
/// A room is no larger to each side and upwards, m: beyond is a mistake in the unit, or no room.
const WALL_MOST_M: f64 = 10_000.0;
/// Characters of a vehicle's or a rotor's name.
const NAME_CHARS: usize = 200;
/// Characters of a format that is not known, in its refusal.
const FORMAT_CHARS: usize = 40;

/// A vehicle file as read: the vehicle, what is doubtful about it, and what an identification added.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedVehicle {
    /// checked, SI
    pub vehicle: Vehicle,
    /// sentences about what is possible but hardly meant
    pub warnings: Vec<String>,
    /// the tables that only `model.toml` has
    pub model: ModelTables,
}

/// What `model.toml` has beyond `vehicle.toml`, as written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelTables {
    /// values with standard errors and correlations
    pub identified: Option<toml::Table>,
    /// hashes of the inputs, version, settings
    pub provenance: Option<toml::Table>,
    /// the effects found, one table each
    pub effects: Vec<toml::Table>,
}

/// The vehicle of a `vehicle.toml` or `model.toml`.
///
/// # Errors
/// [`ConfigError`] where the file cannot be read, has an unknown or missing key, or says what cannot be.
pub fn load_vehicle(path: &Path) -> Result<Vehicle, ConfigError> {
    read_vehicle(path).map(|loaded| loaded.vehicle)
}

/// The vehicle of a `vehicle.toml` or `model.toml` with its warnings and the model's own tables.
///
/// # Errors
/// As [`load_vehicle`].
pub fn read_vehicle(path: &Path) -> Result<LoadedVehicle, ConfigError> {
    parse_vehicle(&read_text(path, Kind::Vehicle)?, &text::path(path))
}

/// As [`read_vehicle`], from text; `origin` is named in errors.
///
/// # Errors
/// As [`load_vehicle`].
pub fn parse_vehicle(text: &str, origin: &str) -> Result<LoadedVehicle, ConfigError> {
    check_format(text, origin)?;
    let file: VehicleFile = parse_toml(text, origin, Kind::Vehicle)?;
    let check = Check { origin };
    let mut doubts = Vec::new();
    let gravity_m_s2 =
        check.optional_positive("body.gravity", file.body.gravity)?.unwrap_or(units::GRAVITY_M_S2);
    let vehicle = Vehicle {
        body: rigid_body(&check, &file.body)?,
        propulsion: propulsion(&check, &file.propulsion)?,
        rotors: rotors(&check, file.rotors, &mut doubts)?,
        limits: limits(&check, &file.limits)?,
        anchor: match file.identify.anchor {
            AnchorKey::Thrust => Anchor::Thrust,
            AnchorKey::Mass => Anchor::Mass,
        },
        name: name(&check, "name", &file.name, &mut doubts)?,
        gravity_m_s2,
        guesses: guesses(&check, file.guesses)?,
    };
    let warnings = doubts.into_iter().chain(warnings(&vehicle)).collect();
    let model =
        ModelTables { identified: file.identified, provenance: file.provenance, effects: file.effects };
    Ok(LoadedVehicle { vehicle, warnings, model })
}

/// Largest relative standard error of a guess: beyond, not even the order of magnitude is known.
const GUESS_MOST: f64 = 10.0;

fn guesses(check: &Check<'_>, tables: Vec<GuessTable>) -> Result<Vec<Guess>, ConfigError> {
    let guess = |table: GuessTable| {
        let of = Guessed::ALL.into_iter().find(|of| of.name() == table.of).ok_or_else(|| {
            check.refuse(
                "guess.of",
                format!("one of {}", Guessed::ALL.map(Guessed::name).join(", ")),
                &table.of,
            )
        })?;
        let relative = check.positive("guess.relative_std", table.relative_std)?;
        if relative > GUESS_MOST {
            return Err(check.refuse("guess.relative_std", format!("at most {GUESS_MOST}"), relative));
        }
        Ok(Guess { of, relative, why: text::excerpt(&table.why, NAME_CHARS) })
    };
    tables.into_iter().map(guess).collect()
}

/// Refuses a later form before its unknown keys are refused. What is no TOML is told elsewhere.
fn check_format(text: &str, origin: &str) -> Result<(), ConfigError> {
    let table: Option<toml::Table> = toml::from_str(text).ok();
    let Some(format) = table.and_then(|table| table.get("format").cloned()) else { return Ok(()) };
    let known = format.as_integer().is_some_and(|format| (1..=i64::from(FORMAT)).contains(&format));
    let came = || text::excerpt(&format.to_string(), FORMAT_CHARS);
    if known {
        Ok(())
    } else {
        Err(ConfigError::Format { origin: origin.to_owned(), known: FORMAT, came: came() })
    }
}

fn propulsion(check: &Check<'_>, table: &PropulsionTable) -> Result<Propulsion, ConfigError> {
    if let (Some(speed), Some(thrust)) = (table.speed_max, table.thrust_max) {
        let expected = "either speed_max (with thrust_coefficient) or thrust_max (with thrust_expo)";
        return Err(check.refuse(
            "propulsion",
            expected,
            format!("speed_max = {speed} and thrust_max = {thrust}"),
        ));
    }
    let by_speed = match table.actuator {
        ActuatorKind::Speed => true,
        ActuatorKind::Thrust => false,
        ActuatorKind::Pwm => table.speed_max.is_some(),
    };
    let (law, thrust_coefficient, torque_per_thrust_m) =
        if by_speed { speed_law(check, table)? } else { curve_law(check, table)? };
    Ok(Propulsion {
        actuator: actuator(check, table)?,
        law,
        thrust_coefficient,
        torque_per_thrust_m,
        rotor_radius_m: check.optional_positive("propulsion.rotor_radius", table.rotor_radius)?,
        time_constant_s: table
            .time_constant
            .map(|value| check.not_negative("propulsion.time_constant", value))
            .transpose()?,
        time_constant_down_s: falling_time_constant(check, table)?,
    })
}

/// The time constant of rotors that slow down, s. It needs that of rotors that speed up.
fn falling_time_constant(check: &Check<'_>, table: &PropulsionTable) -> Result<Option<f64>, ConfigError> {
    let because = "time_constant_down is that of falling speed beside that of rising speed";
    if table.time_constant_down.is_some() {
        check.required("propulsion.time_constant", table.time_constant, because)?;
    }
    check.optional_positive("propulsion.time_constant_down", table.time_constant_down)
}

/// Law, thrust coefficient, torque per thrust.
type Law = (ThrustLaw, Option<f64>, f64);

fn speed_law(check: &Check<'_>, table: &PropulsionTable) -> Result<Law, ConfigError> {
    let because = "the thrust is thrust_coefficient * (u * speed_max)^2";
    let positive = |key: &str, value| check.positive(key, check.required(key, value, because)?);
    let speed_max_rad_s = positive("propulsion.speed_max", table.speed_max)?;
    let coefficient = positive("propulsion.thrust_coefficient", table.thrust_coefficient)?;
    let key = "propulsion.torque_coefficient";
    let torque = check.not_negative(key, check.required(key, table.torque_coefficient, because)?)?;
    for (key, value) in [
        ("propulsion.thrust_max", table.thrust_max),
        ("propulsion.thrust_expo", table.thrust_expo),
        ("propulsion.torque_ratio", table.torque_ratio),
    ] {
        check.absent(key, value, because)?;
    }
    Ok((ThrustLaw::Speed { speed_max_rad_s }, Some(coefficient), torque / coefficient))
}

fn curve_law(check: &Check<'_>, table: &PropulsionTable) -> Result<Law, ConfigError> {
    let because = "the thrust is thrust_max * ((1 - thrust_expo) * u + thrust_expo * u^2)";
    check.absent("propulsion.speed_max", table.speed_max, because)?;
    check.absent("propulsion.torque_coefficient", table.torque_coefficient, because)?;
    let required = |key: &str, value| check.required(key, value, because);
    let key = "propulsion.thrust_max";
    let thrust_max_n = check.positive(key, required(key, table.thrust_max)?)?;
    let key = "propulsion.thrust_expo";
    let expo = check.finite(key, required(key, table.thrust_expo)?)?;
    if !(0.0..=1.0).contains(&expo) {
        return Err(check.refuse(key, "a number from 0 (linear) to 1 (quadratic)", expo));
    }
    let key = "propulsion.torque_ratio";
    let torque_ratio_m = check.not_negative(key, required(key, table.torque_ratio)?)?;
    let coefficient = check.optional_positive("propulsion.thrust_coefficient", table.thrust_coefficient)?;
    Ok((ThrustLaw::Curve { thrust_max_n, expo }, coefficient, torque_ratio_m))
}

fn actuator(check: &Check<'_>, table: &PropulsionTable) -> Result<Actuator, ConfigError> {
    let (min_key, max_key) = ("propulsion.pwm_min", "propulsion.pwm_max");
    let other = match table.actuator {
        ActuatorKind::Speed => Actuator::Speed,
        ActuatorKind::Thrust => Actuator::Thrust,
        ActuatorKind::Pwm => return pwm(check, table, (min_key, max_key)),
    };
    let because = "`propulsion.actuator` is not \"pwm\"";
    check.absent(min_key, table.pwm_min, because)?;
    check.absent(max_key, table.pwm_max, because)?;
    Ok(other)
}

/// Without a range the recorded values are fractions of full scale, which only the speed law may leave out:
/// with the curve law, fractions are `actuator = "thrust"`.
fn pwm(check: &Check<'_>, table: &PropulsionTable, keys: (&str, &str)) -> Result<Actuator, ConfigError> {
    if table.pwm_min.is_none() && table.pwm_max.is_none() && table.speed_max.is_some() {
        return Ok(Actuator::Pwm(None));
    }
    let because = "pulse widths need both ends of their range (for values 0..1 use actuator = \"thrust\")";
    let min_us = check.finite(keys.0, check.required(keys.0, table.pwm_min, because)?)?;
    let max_us = check.finite(keys.1, check.required(keys.1, table.pwm_max, because)?)?;
    check.ordered((keys.0, Some(min_us)), (keys.1, Some(max_us)))?;
    Ok(Actuator::Pwm(Some(PwmRange { min_us, max_us })))
}

/// A name as it is shown everywhere: what would command a terminal or break a line is escaped, and told.
fn name(check: &Check<'_>, key: &str, given: &str, doubts: &mut Vec<String>) -> Result<String, ConfigError> {
    if given.chars().count() > NAME_CHARS {
        return Err(check.refuse(key, format!("at most {NAME_CHARS} characters"), given.chars().count()));
    }
    let name = text::clean(given);
    if name != given {
        doubts
            .push(format!("{key}: expected characters that can be seen; the others are shown as in {name}"));
    }
    Ok(name)
}

fn rotors(
    check: &Check<'_>,
    tables: Vec<RotorTable>,
    doubts: &mut Vec<String>,
) -> Result<Vec<Rotor>, ConfigError> {
    if tables.is_empty() {
        return Err(check.refuse("rotor", "at least one [[rotor]] table", "none"));
    }
    if tables.len() > ROTORS_MAX {
        return Err(check.refuse("rotor", format!("at most {ROTORS_MAX} [[rotor]] tables"), tables.len()));
    }
    let mut names = BTreeSet::new();
    let mut rotors = Vec::with_capacity(tables.len());
    for (index, table) in tables.into_iter().enumerate() {
        let name = name(check, &format!("rotor[{index}].name"), &table.name, doubts)?;
        if !names.insert(name.clone()) {
            let came = format!("\"{name}\" twice");
            return Err(check.refuse(&format!("rotor[{index}].name"), "a name of its own", came));
        }
        rotors.push(Rotor {
            position_m: check.finite_vector(&format!("rotor[{index}].position"), table.position)?,
            spin: match table.spin {
                SpinKey::Cw => Spin::Cw,
                SpinKey::Ccw => Spin::Ccw,
            },
            name,
        });
    }
    Ok(rotors)
}

pub(super) fn limits(check: &Check<'_>, table: &LimitsTable) -> Result<Limits, ConfigError> {
    let positive = |key: &str, value| check.optional_positive(&format!("limits.{key}"), value);
    let finite = |key: &str, value| check.optional_finite(&format!("limits.{key}"), value);
    let angle = |key: &str, deg| -> Result<Option<f64>, ConfigError> {
        Ok(positive(key, deg)?.map(units::rad_from_deg))
    };
    let limits = Limits {
        roll_max_rad: angle("roll_max_deg", table.roll_max_deg)?,
        pitch_max_rad: angle("pitch_max_deg", table.pitch_max_deg)?,
        yaw_max_rad: angle("yaw_max_deg", table.yaw_max_deg)?,
        yaw_rate_max_rad_s: angle("yaw_rate_max_deg_s", table.yaw_rate_max_deg_s)?,
        yaw_acceleration_max_rad_s2: angle("yaw_acceleration_max_deg_s2", table.yaw_acceleration_max_deg_s2)?,
        x_max_m: positive("x_max_m", table.x_max_m)?,
        y_max_m: positive("y_max_m", table.y_max_m)?,
        z_min_m: finite("z_min_m", table.z_min_m)?,
        z_max_m: finite("z_max_m", table.z_max_m)?,
        speed_max_m_s: positive("speed_max_m_s", table.speed_max_m_s)?,
        acceleration_max_m_s2: positive("acceleration_max_m_s2", table.acceleration_max_m_s2)?,
        vertical_acceleration_min_m_s2: finite(
            "vertical_acceleration_min_m_s2",
            table.vertical_acceleration_min_m_s2,
        )?,
        vertical_acceleration_max_m_s2: finite(
            "vertical_acceleration_max_m_s2",
            table.vertical_acceleration_max_m_s2,
        )?,
        thrust_max_n: positive("thrust_max_n", table.thrust_max_n)?,
        torque_max_nm: positive("torque_max_nm", table.torque_max_nm)?,
    };
    for (key, wall_m) in
        [("x_max_m", limits.x_max_m), ("y_max_m", limits.y_max_m), ("z_max_m", limits.z_max_m)]
    {
        if let Some(came) = wall_m.filter(|wall_m| *wall_m > WALL_MOST_M) {
            return Err(check.refuse(&format!("limits.{key}"), format!("at most {WALL_MOST_M} m"), came));
        }
    }
    check.ordered(("limits.z_min_m", limits.z_min_m), ("limits.z_max_m", limits.z_max_m))?;
    check.ordered(
        ("limits.vertical_acceleration_min_m_s2", limits.vertical_acceleration_min_m_s2),
        ("limits.vertical_acceleration_max_m_s2", limits.vertical_acceleration_max_m_s2),
    )?;
    for (key, angle) in [("roll_max_deg", limits.roll_max_rad), ("pitch_max_deg", limits.pitch_max_rad)] {
        if let Some(rad) = angle.filter(|rad| *rad >= std::f64::consts::FRAC_PI_2) {
            let came = units::deg_from_rad(rad);
            return Err(check.refuse(&format!("limits.{key}"), "an angle below 90 degrees", came));
        }
    }
    Ok(limits)
}

#[cfg(test)]
#[path = "vehicle_tests.rs"]
mod tests;
