//! An effect that was named, with its values and the evidence for it.

use crate::text::with_error;
use std::fmt;

/// A named effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Named {
    /// which
    pub id: &'static str,
    /// the effect's sentence
    pub sentence: &'static str,
    /// values
    pub parameters: Vec<NamedParameter>,
    /// evidence
    pub strength: Strength,
    /// effects from which the flight does not distinguish it
    pub confusable_with: Vec<Confusable>,
}

/// A parameter of a named effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedParameter {
    /// as [`crate::physics::Parameter`] has it
    pub name: &'static str,
    /// in `unit`
    pub value: f64,
    /// standard error; 0 if the value was set and not estimated
    pub std: f64,
    /// SI
    pub unit: &'static str,
}

/// The parameters of an effect with their standard errors, on one line.
struct Size<'a>(&'a [NamedParameter]);

impl fmt::Display for Size<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, NamedParameter { name, value, std, unit }) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { ", " };
            write!(f, "{separator}{name} {} {unit}", with_error(*value, *std))?;
        }
        Ok(())
    }
}

/// How strong the evidence was when the effect was taken.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strength {
    /// normal deviate
    pub z: f64,
    /// share of the residual energy that it explains (0..1)
    pub gain: f64,
    /// energy in sigma squared
    pub energy: f64,
    /// coefficients
    pub count: usize,
}

/// Another effect that explains the same residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confusable {
    /// which
    pub id: &'static str,
    /// distance in standard deviations in this flight, if it could be computed
    pub distinguishability: Option<f64>,
}

/// The smallest size at which an effect would have been named in this flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectionLimit {
    /// which effect
    pub id: &'static str,
    /// which parameter
    pub parameter: &'static str,
    /// in `unit`
    pub limit: f64,
    /// in `unit`: from which on it is certain, whether it matters or not
    pub certain: f64,
    /// size on ordinary vehicles, in `unit`, of an effect that appears only in motion
    pub usual: Option<f64>,
    /// greatest size that is searched, in `unit`: no vehicle has more
    pub most: f64,
    /// SI
    pub unit: &'static str,
}

impl DetectionLimit {
    /// Whether an effect of that size is possible. If not, this flight says nothing of it.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        self.limit <= self.most
    }
}

impl Named {
    /// Emits it as a tracing event.
    pub(super) fn emit(&self) {
        let Strength { z, gain, energy, .. } = self.strength;
        tracing::info!(effect = self.id, size = %Size(&self.parameters), z, gain, energy, "effect named");
    }

    /// A parameter by its name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&NamedParameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// A parameter's value in its unit; zero where it is not among the parameters.
    #[must_use]
    pub fn value(&self, name: &str) -> f64 {
        self.get(name).map_or(0.0, |parameter| parameter.value)
    }

    /// Value and standard error as text, multiplied by `factor` for the displayed unit.
    #[must_use]
    pub fn said(&self, name: &str, factor: f64) -> String {
        self.get(name).map_or_else(|| "0".to_owned(), |p| with_error(factor * p.value, factor.abs() * p.std))
    }
}
