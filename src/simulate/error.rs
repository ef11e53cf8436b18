//! Why a simulation could not be made.

use super::PLANT_STATES;
use crate::physics::PhysicsError;

/// Why a simulation could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// the vehicle is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// a setting out of range
    #[error("{name} must be {expected}, got {value}")]
    Setting {
        /// which
        name: &'static str,
        /// the range
        expected: &'static str,
        /// what came
        value: f64,
    },
    /// more own states than the fixed capacity
    #[error("the effects need {count} own states, at most {} fit", PLANT_STATES - crate::physics::RIGID_STATES)]
    TooManyStates {
        /// what they need
        count: usize,
    },
    /// the rotors cannot produce independent thrust and torques
    #[error(
        "the mixer of {rotors} rotors has no right inverse: thrust and three torques are not independent"
    )]
    Allocation {
        /// how many rotors
        rotors: usize,
    },
    /// the state left every bound
    #[error("the simulation left all bounds at {time_s:.3} s: {what}")]
    Diverged {
        /// s
        time_s: f64,
        /// which quantity
        what: &'static str,
    },
    /// adaptive step below its least size
    #[error("the step fell below {least_s:e} s at {time_s} s: the tolerance cannot be met")]
    StepTooSmall {
        /// s
        time_s: f64,
        /// s
        least_s: f64,
    },
}
