//! Why effects cannot be identified.

use super::wanted;
use crate::diagnose::trace::TraceError;
use crate::physics::PhysicsError;

/// Why effects cannot be identified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum JointError {
    /// no effect of this name
    #[error("no effect `{id}`; expected one or more of {}", wanted::names())]
    Unknown {
        /// what came
        id: String,
    },
    /// twice the same
    #[error("effect {id} is named twice; expected each name once")]
    Twice {
        /// which
        id: &'static str,
    },
    /// no effect beside the rigid body
    #[error(
        "{id} is identified with mass and inertia in any case; name the effects beside them: {}",
        wanted::names()
    )]
    Always {
        /// which
        id: String,
    },
    /// irregular by nature
    #[error(
        "gust cannot be identified as parameters: a gust is one random course of the wind that does not repeat, and \
         force and torque are not a function of its strength and correlation time; `mavid explain` gives both from \
         the remaining residual"
    )]
    Gust,
    /// wind has no force of its own
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
        /// what for
        why: &'static str,
    },
    /// its time belongs to one flight
    #[error("effect {id} happens at a time of one flight; expected one recording, got {flights}")]
    SeveralFlights {
        /// which effect
        id: &'static str,
        /// how many came
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
