//! Errors of the refit.

use crate::diagnose::trace::TraceError;
use crate::physics::PhysicsError;
use crate::simulate::SimulateError;

/// Errors of the refit.
#[derive(Debug, thiserror::Error)]
pub enum RefitError {
    /// velocity, attitude and rates must be known
    #[error("multiple shooting needs velocity, attitude and body rates")]
    NotMeasured,
    /// effects with states, whose initial values are unknown
    #[error("effect {id} has states of its own, whose start no segment knows")]
    OwnStates {
        /// which
        id: &'static str,
    },
    /// too little flight
    #[error("only {segments} segments of {segment_s} s fit into the flights, at least {needed} are needed")]
    TooShort {
        /// segments that fit
        segments: usize,
        /// s
        segment_s: f64,
        /// needed
        needed: usize,
    },
    /// physically impossible inertia
    #[error(
        "the identified inertia is that of no body (one principal moment exceeds the sum of the others): a refit that keeps to physics cannot start from it"
    )]
    NoBody,
    /// the information is singular
    #[error("the segments do not determine all parameters")]
    NotDetermined,
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// the model cannot be simulated
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}
