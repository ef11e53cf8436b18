//! Why a flight cannot be reconstructed.

use super::fit::FitError;
use crate::recording::Quantity;

/// Why a flight cannot be reconstructed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReconstructionError {
    /// a stream that the equations need
    #[error("expected a stream of {}, got none", .0.name())]
    Missing(Quantity),
    /// not enough flight
    #[error("expected at least 8 s in the air, a metre above the ground, got less")]
    TooShort,
    /// more effects, or more values of one, than an equation holds
    #[error("expected at most 16 effects with at most 16 values each, got more")]
    TooMany,
    /// the vehicle lacks something
    #[error("the vehicle: {0}")]
    Vehicle(String),
    /// the data do not determine it
    #[error(transparent)]
    Fit(#[from] FitError),
}
