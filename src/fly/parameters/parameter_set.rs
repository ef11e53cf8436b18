//! Parameters of a vehicle, and their file.

use crate::autopilot::{Autopilot, Renamed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Parameters of a vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parameters {
    /// autopilot, which defines names and meanings
    pub autopilot: Autopilot,
    /// value by the name that answered, in the autopilot's own unit
    pub values: BTreeMap<String, f64>,
    /// requested without an answer: it may or may not exist
    pub unanswered: Vec<String>,
    /// requested, and the vehicle reported that it has no parameter of that name
    pub absent: Vec<String>,
}

impl Parameters {
    /// The newer name that answered for this older one.
    fn answered(&self, name: &str) -> Option<&'static Renamed> {
        let mut renames = self.autopilot.stack()?.parameters.renames_of(name);
        renames.find(|renamed| self.values.contains_key(renamed.new))
    }

    /// The value in the unit of the older name, whichever of a renamed parameter's names answered;
    /// `name` is the older one.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values.get(name).copied().or_else(|| {
            let renamed = self.answered(name)?;
            self.values.get(renamed.new).map(|value| value * renamed.scale)
        })
    }

    /// The value in its base unit (SI, but degrees for angles); `name` is the older one.
    #[must_use]
    pub fn in_base_unit(&self, name: &str) -> Option<f64> {
        let entry = self.autopilot.stack()?.parameters.find(name)?;
        self.get(name).map(|value| 1.0 / entry.unit.per_base * value)
    }

    /// The name by which this vehicle knows a parameter (older name given), for messages and advice.
    #[must_use]
    pub fn name_of<'a>(&self, name: &'a str) -> &'a str {
        self.answered(name).map_or(name, |renamed| renamed.new)
    }

    /// A value in the older name's unit, written in the unit that this vehicle uses, for advice.
    #[must_use]
    pub fn in_own_unit(&self, name: &str, value: f64) -> f64 {
        self.answered(name).map_or(value, |renamed| value / renamed.scale)
    }

    /// The text of `parameters.toml`.
    ///
    /// # Errors
    /// If a number cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, ParametersError> {
        let file = ParametersFile {
            autopilot: self.autopilot.id().to_owned(),
            unanswered: self.unanswered.clone(),
            absent: self.absent.clone(),
            values: self.values.clone(),
        };
        Ok(format!("{HEADER}{}", toml::to_string(&file)?))
    }

    /// Reads what [`Self::to_toml`] writes; `origin` names it in errors.
    ///
    /// # Errors
    /// If the text is not TOML or has unknown keys.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, ParametersError> {
        let file: ParametersFile = toml::from_str(text).map_err(|source| ParametersError::Parse {
            origin: origin.to_owned(),
            source: Box::new(source),
        })?;
        Ok(Self {
            autopilot: Autopilot::of_id(&file.autopilot),
            values: file.values,
            unanswered: file.unanswered,
            absent: file.absent,
        })
    }
}

/// Errors of a parameter file.
#[derive(Debug, thiserror::Error)]
pub enum ParametersError {
    /// not this form of TOML
    #[error("{origin}: expected a table of parameters, {source}")]
    Parse {
        /// the file
        origin: String,
        /// what the parser says
        source: Box<toml::de::Error>,
    },
    /// a number that TOML cannot hold
    #[error("parameters cannot be written: {0}")]
    Write(#[from] toml::ser::Error),
}

/// The file.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct ParametersFile {
    autopilot: String,
    unanswered: Vec<String>,
    absent: Vec<String>,
    values: BTreeMap<String, f64>,
}

const HEADER: &str = "# Parameters as the vehicle sent them before the flight, each in the autopilot's own unit.\n\
    # unanswered: asked for, and no answer came. absent: the vehicle has none of that name.\n";

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(values: &[(&str, f64)]) -> Parameters {
        Parameters {
            autopilot: Autopilot::ArduPilot,
            values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Parameters::default()
        }
    }

    #[test]
    fn a_renamed_parameter_has_one_value_under_both_names() {
        let old = parameters(&[("WPNAV_ACCEL", 250.0), ("ANGLE_MAX", 3000.0)]);
        let new = parameters(&[("WP_ACC", 2.5), ("ATC_ANGLE_MAX", 30.0)]);
        for name in ["WPNAV_ACCEL", "ANGLE_MAX"] {
            assert_eq!(old.get(name), new.get(name), "{name}");
        }
        assert_eq!((new.name_of("WPNAV_ACCEL"), old.name_of("WPNAV_ACCEL")), ("WP_ACC", "WPNAV_ACCEL"));
        assert_eq!(new.in_own_unit("WPNAV_ACCEL", 400.0), 4.0);
        assert_eq!(new.get("WPNAV_SPEED"), None);
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut stored = parameters(&[("MOT_THST_EXPO", f64::from(0.65_f32)), ("FRAME_CLASS", 1.0)]);
        stored.unanswered = vec!["MOT_BAT_VOLT_MAX".into()];
        stored.absent = vec!["WP_ACC".into()];
        let text = stored.to_toml().unwrap();
        assert_eq!(Parameters::from_toml(&text, "parameters.toml").unwrap(), stored);
        let error = Parameters::from_toml("value = 1", "p.toml").unwrap_err().to_string();
        assert!(error.contains("p.toml"), "{error}");
    }
}
