//! Why effects cannot be identified.

use super::wanted;
use crate::diagnose::trace_error::TraceError;
use crate::physics::PhysicsError;

/// Why effects cannot be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum JointError {
    /// no effect of this name
    #[error("no effect `{id}`; expected one or more of {}", wanted::names())]
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
        wanted::names()
    )]
    Always {
        /// which
        id: String,
    },
    /// an effect that is not a function of its parameters
    #[error(
        "gust cannot be identified as parameters: a gust is one random course of the wind that does not repeat, and \
         force and torque are not a function of its strength and correlation time; `mavid explain` gives both from \
         the remaining residual"
    )]
    Gust,
    /// wind without an aerodynamic force
    #[error(
        "steady_wind shows only through forces of the air; expected it together with linear_drag, quadratic_drag, blade_flapping, \
         translational_lift, inflow or vortex_ring, by name or in the vehicle file, got none of them"
    )]
    WindAlone,
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
        "{seconds:.1} s of flight can be used, at least {needed_s:.0} s are needed to tell effects from noise"
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
