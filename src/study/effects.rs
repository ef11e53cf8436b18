//! Effects of a model, of a file of their own, and as the vehicle states them.

use std::path::Path;

use crate::config::{each_once, effects_of, read_effect_tables};
use crate::physics::ActiveEffect;
use crate::text;
use crate::vehicle::Vehicle;

use super::StudyError;

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
    each_once(&all, &format!("{origin} and {} together", text::path(&path)))?;
    Ok(all)
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
    Ok(effects_of(&read_effect_tables(path)?, &text::path(path), vehicle)?)
}
