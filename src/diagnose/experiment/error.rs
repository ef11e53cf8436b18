//! Errors of the design of the next flight.

use super::flight::Inseparable;
use crate::diagnose::sentence::called;
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
    #[error("no flight inside the limits shows {}", called(.0))]
    NoRoom(&'static str),
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the model is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_that_nothing_shows_has_its_name_and_not_its_identifier() {
        let said = NextError::NoRoom("motor_lag").to_string();
        assert!(said.ends_with(called("motor_lag")) && !said.contains('_'), "{said}");
    }
}
