//! Checks of single values, with the file and the key in every refusal.

use nalgebra::Vector3;

use super::ConfigError;
use crate::text;

/// Smallest size (SI) above zero that is read: smaller ones are no vehicle's, and their products would vanish.
const SMALLEST: f64 = 1e-18;
/// Largest size (SI) that is read: larger ones are no vehicle's, and their products would overflow.
const LARGEST: f64 = 1e12;

/// Characters of a value that a refusal repeats.
const CAME_CHARS: usize = 200;

/// Names the file in every error.
pub(super) struct Check<'a> {
    /// file name, or what the text is
    pub origin: &'a str,
}

impl Check<'_> {
    /// A refusal.
    pub fn refuse(
        &self,
        key: &str,
        expected: impl Into<String>,
        came: impl std::fmt::Display,
    ) -> ConfigError {
        ConfigError::Invalid {
            origin: self.origin.to_owned(),
            key: key.to_owned(),
            expected: expected.into(),
            // what the file says may be anything
            came: text::excerpt(&came.to_string(), CAME_CHARS),
        }
    }

    /// Three finite numbers.
    pub fn finite_vector(&self, key: &str, values: [f64; 3]) -> Result<Vector3<f64>, ConfigError> {
        for value in values {
            self.finite(key, value)?;
        }
        Ok(Vector3::from(values))
    }

    /// Neither NaN nor infinite nor beyond all measure.
    pub fn finite(&self, key: &str, value: f64) -> Result<f64, ConfigError> {
        self.within(key, value, (value.abs() <= LARGEST, "a finite number"))
    }

    /// Finite and above zero.
    pub fn positive(&self, key: &str, value: f64) -> Result<f64, ConfigError> {
        self.within(key, value, ((SMALLEST..=LARGEST).contains(&value), "a number above zero"))
    }

    /// Finite and not below zero.
    pub fn not_negative(&self, key: &str, value: f64) -> Result<f64, ConfigError> {
        self.within(key, value, ((0.0..=LARGEST).contains(&value), "a number not below zero"))
    }

    /// At least 0 and at most 1.
    pub fn share(&self, key: &str, value: f64) -> Result<f64, ConfigError> {
        self.within(key, value, ((0.0..=1.0).contains(&value), "a share of 0 to 1"))
    }

    fn within(&self, key: &str, value: f64, (holds, expected): (bool, &str)) -> Result<f64, ConfigError> {
        if holds {
            return Ok(value);
        }
        let size = value.abs();
        let beyond = size.is_finite() && (size > LARGEST || (size > 0.0 && size < SMALLEST));
        let range = if beyond { format!(", of size {SMALLEST:e} to {LARGEST:e}") } else { String::new() };
        Err(self.refuse(key, format!("{expected}{range}"), format!("{value:?}")))
    }

    /// Finite where it is given.
    pub fn optional_finite(&self, key: &str, value: Option<f64>) -> Result<Option<f64>, ConfigError> {
        value.map(|value| self.finite(key, value)).transpose()
    }

    /// Finite and above zero where it is given.
    pub fn optional_positive(&self, key: &str, value: Option<f64>) -> Result<Option<f64>, ConfigError> {
        value.map(|value| self.positive(key, value)).transpose()
    }

    /// Seconds above zero, and no more than `max_s`.
    pub fn duration(&self, key: &str, value: f64, max_s: f64) -> Result<f64, ConfigError> {
        if value > 0.0 && value <= max_s {
            return Ok(value);
        }
        Err(self.refuse(key, format!("above 0 and at most {max_s} s"), format!("{value:?} s")))
    }

    /// Present; `because` says what asks for it.
    pub fn required(&self, key: &str, value: Option<f64>, because: &str) -> Result<f64, ConfigError> {
        value.ok_or_else(|| self.refuse(key, format!("a number, since {because}"), "nothing"))
    }

    /// Absent; `because` says what it contradicts.
    pub fn absent(&self, key: &str, value: Option<f64>, because: &str) -> Result<(), ConfigError> {
        match value {
            None => Ok(()),
            Some(value) => Err(self.refuse(key, format!("no such key, since {because}"), value)),
        }
    }

    /// `low < high` where both are given.
    pub fn ordered(&self, low: (&str, Option<f64>), high: (&str, Option<f64>)) -> Result<(), ConfigError> {
        match (low.1, high.1) {
            (Some(below), Some(above)) if below >= above => {
                Err(self.refuse(low.0, format!("a number below `{}` = {above}", high.0), below))
            }
            _ => Ok(()),
        }
    }
}
