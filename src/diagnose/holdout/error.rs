//! Errors of the comparison with a hold-out flight.

use crate::compare::CompareError;
use crate::diagnose::trace_error::TraceError;
use crate::physics::PhysicsError;

/// Errors of the comparison with a hold-out flight.
#[derive(Debug, thiserror::Error)]
pub enum HoldoutError {
    /// no hold-out flight
    #[error("expected at least one flight to show the model on, got none")]
    NoFlight,
    /// streams are missing
    #[error("{flight}: {source}")]
    Trace {
        /// which flight
        flight: String,
        /// why
        source: TraceError,
    },
    /// cannot be played back
    #[error("{flight}: {source}")]
    Compare {
        /// which flight
        flight: String,
        /// why
        source: CompareError,
    },
    /// too little flight
    #[error(
        "{flight}: {seconds:.1} s of flight can be used, at least {needed_s:.0} s are needed to show a fit"
    )]
    TooShort {
        /// which flight
        flight: String,
        /// s that can be used
        seconds: f64,
        /// s needed
        needed_s: f64,
    },
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}
