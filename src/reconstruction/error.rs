//! Why a flight cannot be reconstructed.

use super::fit::FitError;
use crate::recording::Quantity;
use crate::signals::SignalsError;

/// Why a flight cannot be reconstructed.
#[derive(Debug, thiserror::Error)]
pub enum ReconstructionError {
    /// a stream that the equations need
    #[error("expected a stream of {}, got none", .0.name())]
    Missing(Quantity),
    /// no thrusts
    #[error(transparent)]
    Signals(#[from] SignalsError),
    /// not enough flight
    #[error("expected at least 4 s in the air, a metre above the ground, got less")]
    TooShort,
    /// the vehicle lacks something
    #[error("the vehicle: {0}")]
    Vehicle(String),
    /// the data do not determine it
    #[error(transparent)]
    Fit(#[from] FitError),
}
