//! From the written vehicle to the checked one, and back.

use std::collections::BTreeSet;
use std::path::Path;

use nalgebra::Vector3;

use super::ConfigError;
use super::check::Check;
use super::effects;
use super::faults::Faults;
use super::kind::Kind;
use super::propulsion::propulsion;
use super::read::{parse_toml_on, read_text};
use super::rigid_body::rigid_body;
use super::vehicle_file::{AnchorKey, FORMAT, GuessTable, LimitsTable, RotorTable, SpinKey, VehicleFile};
use crate::note::{About, Note};
use crate::text;
use crate::units;
use crate::vehicle::{Anchor, Guess, Guessed, Limits, Rotor, Spin, Vehicle};

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
    /// what is possible but hardly meant
    pub warnings: Vec<Note>,
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
    /// the effects found, one table each; [`super::effects_of`] makes them, and of a file they are checked
    pub effects: Vec<toml::Table>,
}

/// The vehicle of a `vehicle.toml` or `model.toml`.
///
/// # Errors
/// [`ConfigError`] where the file cannot be read, has an unknown or missing key, or says what cannot be: all of it at once.
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
    let (file, mut faults): (VehicleFile, Faults) = parse_toml_on(text, origin, Kind::Vehicle)?;
    let check = Check { origin };
    let mut doubts = Vec::new();
    let gravity = check.optional_positive("body.gravity", file.body.gravity);
    let vehicle = Vehicle {
        gravity_m_s2: faults.optional(gravity).unwrap_or(units::GRAVITY_M_S2),
        body: rigid_body(&check, &file.body, &mut faults),
        propulsion: propulsion(&check, &file.propulsion, &mut faults),
        rotors: rotors(&check, file.rotors, &mut doubts, &mut faults),
        name: faults.take(name(&check, "name", &file.name, &mut doubts), String::new()),
        limits: limits(&check, &file.limits, &mut faults),
        anchor: match file.identify.anchor {
            AnchorKey::Thrust => Anchor::Thrust,
            AnchorKey::Mass => Anchor::Mass,
        },
        guesses: guesses(&check, file.guesses, &mut faults),
    };
    let sound = (faults.count() == 0).then_some(&vehicle);
    effects::checked(&check, &file.effects, sound, &mut faults);
    faults.refuse(origin)?;
    let doubts = doubts.into_iter().chain(vehicle.implausible());
    let warnings = doubts.map(|doubt| Note::warning(About::Vehicle, doubt)).collect();
    let model =
        ModelTables { identified: file.identified, provenance: file.provenance, effects: file.effects };
    Ok(LoadedVehicle { vehicle, warnings, model })
}

/// Largest relative standard error of a guess: beyond, not even the order of magnitude is known.
const GUESS_MOST: f64 = 10.0;

fn guesses(check: &Check<'_>, tables: Vec<GuessTable>, faults: &mut Faults) -> Vec<Guess> {
    let guess = |(index, table): (usize, GuessTable)| {
        let key = format!("guess[{index}].of");
        let of = Guessed::ALL.into_iter().find(|of| of.name() == table.of).ok_or_else(|| {
            check.refuse(&key, format!("one of {}", Guessed::ALL.map(Guessed::name).join(", ")), &table.of)
        });
        let of = faults.optional(of.map(Some));
        let key = format!("guess[{index}].relative_std");
        let relative = faults.number(check.positive(&key, table.relative_std));
        if relative > GUESS_MOST {
            faults.check(Err(check.refuse(&key, format!("at most {GUESS_MOST}"), relative)));
        }
        Some(Guess { of: of?, relative, why: text::excerpt(&table.why, NAME_CHARS) })
    };
    tables.into_iter().enumerate().filter_map(guess).collect()
}

/// Refuses another form before its unknown keys are refused. What is no TOML is told elsewhere.
fn check_format(text: &str, origin: &str) -> Result<(), ConfigError> {
    let table: Option<toml::Table> = toml::from_str(text).ok();
    let Some(format) = table.and_then(|table| table.get("format").cloned()) else { return Ok(()) };
    match format.as_integer() {
        Some(number) if (1..=i64::from(FORMAT)).contains(&number) => Ok(()),
        Some(came) if came > i64::from(FORMAT) => {
            Err(ConfigError::Format { origin: origin.to_owned(), known: FORMAT, came })
        }
        _ => Err(ConfigError::Invalid {
            origin: origin.to_owned(),
            key: "format".to_owned(),
            expected: format!("the whole number {FORMAT} or no such key"),
            came: text::excerpt(&format.to_string(), FORMAT_CHARS),
        }),
    }
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
    faults: &mut Faults,
) -> Vec<Rotor> {
    let few = (1..=ROTORS_MAX).contains(&tables.len());
    if !few {
        let (expected, came) = match tables.len() {
            0 => ("at least one [[rotor]] table".to_owned(), "none".to_owned()),
            count => (format!("at most {ROTORS_MAX} [[rotor]] tables"), count.to_string()),
        };
        faults.check(Err(check.refuse("rotor", expected, came)));
        return Vec::new();
    }
    let mut names = BTreeSet::new();
    let mut rotors = Vec::with_capacity(tables.len());
    for (index, table) in tables.into_iter().enumerate() {
        let key = format!("rotor[{index}].name");
        let name = faults.take(name(check, &key, &table.name, doubts), String::new());
        if !names.insert(name.clone()) {
            let came = format!("\"{name}\" twice");
            faults.check(Err(check.refuse(&key, "a name of its own", came)));
        }
        let position = check.finite_vector(&format!("rotor[{index}].position"), table.position);
        rotors.push(Rotor {
            position_m: faults.take(position, Vector3::zeros()),
            spin: match table.spin {
                SpinKey::Cw => Spin::Cw,
                SpinKey::Ccw => Spin::Ccw,
            },
            name,
        });
    }
    rotors
}

/// The limits of another file.
pub(super) fn limits_alone(check: &Check<'_>, table: &LimitsTable) -> Result<Limits, ConfigError> {
    let mut faults = Faults::default();
    let limits = limits(check, table, &mut faults);
    faults.refuse(check.origin).map(|()| limits)
}

/// Name and value of some keys of a table.
macro_rules! keys {
    ($table:ident: $($key:ident),+ $(,)?) => { [$((stringify!($key), $table.$key)),+] };
}

fn known(key: &str) -> String {
    format!("limits.{key}")
}

fn limits(check: &Check<'_>, table: &LimitsTable, faults: &mut Faults) -> Limits {
    let mut positive = |key: &str, value| faults.optional(check.optional_positive(&known(key), value));
    let [roll_max_rad, pitch_max_rad, yaw_max_rad, yaw_rate_max_rad_s, yaw_acceleration_max_rad_s2] = keys!(
        table: roll_max_deg, pitch_max_deg, yaw_max_deg, yaw_rate_max_deg_s, yaw_acceleration_max_deg_s2
    )
    .map(|(key, deg)| positive(key, deg).map(units::rad_from_deg));
    let [x_max_m, y_max_m, speed_max_m_s, acceleration_max_m_s2, thrust_max_n, torque_max_nm] = keys!(
        table: x_max_m, y_max_m, speed_max_m_s, acceleration_max_m_s2, thrust_max_n, torque_max_nm
    )
    .map(|(key, value)| positive(key, value));
    let [z_min_m, z_max_m, vertical_acceleration_min_m_s2, vertical_acceleration_max_m_s2] = keys!(
        table: z_min_m, z_max_m, vertical_acceleration_min_m_s2, vertical_acceleration_max_m_s2
    )
    .map(|(key, value)| faults.optional(check.optional_finite(&known(key), value)));
    let limits = Limits {
        roll_max_rad,
        pitch_max_rad,
        yaw_max_rad,
        yaw_rate_max_rad_s,
        yaw_acceleration_max_rad_s2,
        x_max_m,
        y_max_m,
        z_min_m,
        z_max_m,
        speed_max_m_s,
        acceleration_max_m_s2,
        vertical_acceleration_min_m_s2,
        vertical_acceleration_max_m_s2,
        thrust_max_n,
        torque_max_nm,
    };
    possible(check, &limits, faults);
    limits
}

/// Walls that are near enough, ends in order, angles of a vehicle that is upright.
fn possible(check: &Check<'_>, limits: &Limits, faults: &mut Faults) {
    for (key, wall_m) in keys!(limits: x_max_m, y_max_m, z_max_m) {
        if let Some(came) = wall_m.filter(|wall_m| *wall_m > WALL_MOST_M) {
            faults.check(Err(check.refuse(&known(key), format!("at most {WALL_MOST_M} m"), came)));
        }
    }
    let ends = [
        keys!(limits: z_min_m, z_max_m),
        keys!(limits: vertical_acceleration_min_m_s2, vertical_acceleration_max_m_s2),
    ];
    for [(low, least), (high, most)] in ends {
        faults.check(check.ordered((&known(low), least), (&known(high), most)));
    }
    for (key, angle) in [("roll_max_deg", limits.roll_max_rad), ("pitch_max_deg", limits.pitch_max_rad)] {
        if let Some(rad) = angle.filter(|rad| *rad >= std::f64::consts::FRAC_PI_2) {
            let came = units::deg_from_rad(rad);
            faults.check(Err(check.refuse(&known(key), "an angle below 90 degrees", came)));
        }
    }
}

#[cfg(test)]
#[path = "vehicle_tests.rs"]
mod tests;
