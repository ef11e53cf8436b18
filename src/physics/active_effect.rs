//! An effect with its values.

use super::{Effect, PhysicsError};

/// An effect with its values.
#[derive(Debug, Clone)]
pub struct ActiveEffect {
    pub(super) effect: &'static dyn Effect,
    pub(super) parameters: Vec<f64>,
}

impl ActiveEffect {
    /// # Errors
    /// If the number of values is not that of the effect's parameters, with or without the finer ones, of which the last may be left out.
    pub fn new(effect: &'static dyn Effect, parameters: &[f64]) -> Result<Self, PhysicsError> {
        let (expected, got) = (effect.parameters().len(), parameters.len());
        if !(expected..=expected + effect.finer_parameters().len()).contains(&got) {
            return Err(PhysicsError::ParameterCount { id: effect.id(), expected, got });
        }
        Ok(Self { effect, parameters: parameters.to_vec() })
    }

    /// Which effect.
    #[must_use]
    pub fn effect(&self) -> &'static dyn Effect {
        self.effect
    }

    /// Its values, in the order of [`Effect::parameters`], then of [`Effect::finer_parameters`] if it has them.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }
}
