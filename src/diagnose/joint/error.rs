//! Why effects cannot be identified.

use super::requested;
use crate::diagnose::trace_error::TraceError;
use crate::physics::PhysicsError;

/// Why effects cannot be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum JointError {
    /// no effect of this name
    #[error("no effect `{id}`; expected one or more of {}", requested::names())]
    Unknown {
        /// the requested name
        id: String,
    },
    /// twice the same
    #[error("effect {id} is named twice; expected each name once")]
    Twice {
        /// which
        id: &'static str,
    },
    /// a parameter that is always identified
    #[error(
        "{id} is identified with mass and inertia in any case; name the effects beside them: {}",
        requested::names()
    )]
    Always {
        /// which
        id: String,
    },
    /// an effect that is not a function of its parameters
    #[error("{id} cannot be identified as parameters: {why}")]
    Irregular {
        /// which
        id: &'static str,
        /// why not
        why: &'static str,
    },
    /// wind without an aerodynamic force
    #[error(
        "{id} shows only through forces of the air; expected it together with {}, by name or in the vehicle file, got none \
         of them",
        requested::names_of_air()
    )]
    WindAlone {
        /// the wind
        id: &'static str,
    },
    /// a stream is missing
    #[error("effect {id} needs {what}: {why}; the recording does not hold that")]
    Stream {
        /// which effect
        id: &'static str,
        /// what it needs
        what: &'static str,
        /// why it is needed
        why: &'static str,
    },
    /// an effect at a time of one flight, with several flights
    #[error("effect {id} happens at a time of one flight; expected one recording, got {flights}")]
    SeveralFlights {
        /// which effect
        id: &'static str,
        /// number of flights
        flights: usize,
    },
    /// too little flight
    #[error(
        "{:.1} s of flight can be used, at least {needed_s:.0} s are needed to tell effects from noise",
        (10.0 * .seconds).floor() / 10.0
    )]
    TooShort {
        /// s that can be used
        seconds: f64,
        /// s needed
        needed_s: f64,
    },
    /// streams are missing
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// the vehicle is not physical, or lacks what an effect needs
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}
