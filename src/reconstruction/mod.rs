//! Flight path reconstruction together with the parameters of the motion.
//!
//! States along time (velocity, attitude's error, position, the error of the autopilot's velocity) and parameters (drag,
//! thrust scale, biases, latenesses) are estimated at once, with noise levels that are learned from the flight. What a
//! filter would smooth away before the estimation stays in it.

mod arrow;
mod cells;
mod error;
mod fit;
mod forces;
mod residuals;

pub use arrow::{STATE, State};
pub use error::ReconstructionError;
pub use fit::{BLOCKS, Fit, FitError, Problem, Unknown, fit};
pub use forces::force_problem;
pub use residuals::{Group, Residuals, WIDTH};
