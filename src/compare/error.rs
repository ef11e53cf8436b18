//! Why a recording cannot be compared with a simulation.

use crate::simulate::SimulateError;

/// Why a recording cannot be compared with a simulation.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// a stream that is needed
    #[error("the recording holds no {what}: {purpose} needs it")]
    Missing {
        /// which
        what: &'static str,
        /// for what
        purpose: &'static str,
    },
    /// no window fits
    #[error(
        "no usable stretch of flight is as long as a window of {window_s} s with {warm_up_s} s before it"
    )]
    NoWindow {
        /// s
        window_s: f64,
        /// s
        warm_up_s: f64,
    },
    /// the simulation itself
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}
