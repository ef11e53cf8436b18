//! Errors of the design of the next flight.

use super::flight::Inseparable;
use crate::diagnose::trace_error::TraceError;
use crate::physics::PhysicsError;

/// Errors of the design of the next flight.
#[derive(Debug, thiserror::Error)]
pub enum NextError {
    /// nothing to separate
    #[error(
        "there is nothing to separate: no named effect could be confused with another one, and none would be \
         determined better by more motion"
    )]
    NothingToTell,
    /// pairs that can only be separated by other means
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Inseparable(Vec<Inseparable>),
    /// limits without room
    #[error("no flight inside the limits shows {0}")]
    NoRoom(&'static str),
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}
