//! Why a model has no form in a simulator.

use crate::physics::PhysicsError;

/// Why a model has no form in a simulator.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// it needs what the model does not say
    #[error("{format} needs {what}, but the model does not state it")]
    Missing {
        /// simulator
        format: &'static str,
        /// what
        what: &'static str,
    },
    /// not such a vehicle
    #[error("{format} expects {expected}, the model has {got}")]
    Unfit {
        /// simulator
        format: &'static str,
        /// what it takes
        expected: &'static str,
        /// what came
        got: String,
    },
    /// the vehicle itself
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}
