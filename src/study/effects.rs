//! Effects from the tables of a file: `[[effect]]` with `id` and the parameters by name.

use std::path::Path;

use crate::config::read_effect_tables;
use crate::diagnose::signatures::signature_of;
use crate::physics::ActiveEffect;
use crate::text;
use crate::vehicle::Vehicle;

use super::StudyError;

/// The effects of a model file, which `origin` names in errors. A rotor may be given by its name.
///
/// # Errors
/// [`StudyError::File`] where a table is no effect, or one comes twice.
pub fn effects_of(
    tables: &[toml::Table],
    origin: &str,
    vehicle: &Vehicle,
) -> Result<Vec<ActiveEffect>, StudyError> {
    let all: Result<Vec<_>, String> = tables.iter().map(|table| effect(table, vehicle)).collect();
    all.and_then(each_once).map_err(|why| StudyError::File { file: origin.to_owned(), why })
}

fn each_once(all: Vec<ActiveEffect>) -> Result<Vec<ActiveEffect>, String> {
    for (index, active) in all.iter().enumerate() {
        let id = active.effect().id();
        // each rotor may be weak in its own way
        let which = signature_of(id).and_then(|signature| signature.role.which);
        let again = |other: &&ActiveEffect| {
            other.effect().id() == id
                && which.is_none_or(|slot| other.parameters()[slot] == active.parameters()[slot])
        };
        if all[..index].iter().any(|other| again(&other)) {
            return Err(format!("[[effect]]: expected each effect once, {id} comes twice"));
        }
    }
    Ok(all)
}

/// The effects of a model file with those of a further file, if there is one; each may be in one of them alone.
///
/// # Errors
/// As [`effects_of`], and as [`effects_file`].
pub fn with_further(
    tables: &[toml::Table],
    origin: &Path,
    further: Option<&Path>,
    vehicle: &Vehicle,
) -> Result<Vec<ActiveEffect>, StudyError> {
    let origin = text::path(&origin);
    let mut all = effects_of(tables, &origin, vehicle)?;
    let Some(path) = further else { return Ok(all) };
    all.extend(effects_file(path, vehicle)?);
    let file = format!("{origin} and {} together", text::path(&path));
    each_once(all).map_err(|why| StudyError::File { file, why })
}

/// With the motor lag that the vehicle's `time_constant` states, if no effect is one.
#[must_use]
pub fn with_stated_lag(mut effects: Vec<ActiveEffect>, vehicle: &Vehicle) -> Vec<ActiveEffect> {
    if !effects.iter().any(ActiveEffect::is_rotor_lag) {
        effects.extend(ActiveEffect::stated_rotor_lag(&vehicle.propulsion));
    }
    effects
}

/// The effects of a file that holds nothing but `[[effect]]` tables.
///
/// # Errors
/// [`StudyError::Config`] where it cannot be read; otherwise as [`effects_of`].
pub fn effects_file(path: &Path, vehicle: &Vehicle) -> Result<Vec<ActiveEffect>, StudyError> {
    effects_of(&read_effect_tables(path)?, &text::path(path), vehicle)
}

/// What a rotor may be called.
fn rotors(vehicle: &Vehicle) -> String {
    let names: Vec<&str> = vehicle.rotors.iter().map(|rotor| rotor.name.as_str()).collect();
    format!("a rotor: 0 to {}, or its name ({})", names.len().saturating_sub(1), names.join(", "))
}

fn effect(table: &toml::Table, vehicle: &Vehicle) -> Result<ActiveEffect, String> {
    let id = table
        .get("id")
        .and_then(toml::Value::as_str)
        .ok_or_else(|| format!("[[effect]]: expected `id = \"...\"`, got {table}"))?;
    let mut values = Vec::with_capacity(table.len());
    for (name, value) in table.iter().filter(|(name, _)| *name != "id") {
        let number = match value {
            toml::Value::Float(number) => Some(*number),
            // whole numbers of a file are small
            toml::Value::Integer(number) => i32::try_from(*number).ok().map(f64::from),
            toml::Value::String(rotor) if name == "rotor" => {
                vehicle.rotors.iter().position(|known| known.name == *rotor).map(|index| index as f64)
            }
            _ => None,
        };
        let expected = if name == "rotor" { rotors(vehicle) } else { "a number".to_owned() };
        let refused = || format!("effect {id}, `{name}`: expected {expected}, got {value}");
        let number = number.ok_or_else(refused)?;
        if name == "rotor" && !(0..vehicle.rotors.len()).any(|index| index as f64 == number) {
            return Err(refused());
        }
        values.push((name.as_str(), number));
    }
    ActiveEffect::named(id, &values, &vehicle.size()).map_err(|error| error.to_string())
}
