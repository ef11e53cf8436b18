//! Flight path reconstruction together with the parameters of the motion.
//!
//! States along time (velocity, the attitude's error, the error of the autopilot's velocity) and parameters (drag,
//! thrust scale, biases, latenesses) are estimated at once, with noise levels that are learned from the flight. What a
//! filter would smooth away before the estimation stays in it.

mod arrow;
mod blocks;
mod cells;
mod error;
mod fit;
mod force_problem;
mod forces;
mod place;
mod places;
mod problem;
mod receiver;
mod residuals;
mod sensors;
mod thrusts;

pub use blocks::{STATE, State, WIDTH};
pub use error::ReconstructionError;
pub use fit::{BLOCKS, Fit, FitError, fit, fit_mode};
pub use force_problem::{KnownLag, force_problem};
pub use forces::Term;
pub use problem::{Path, Problem, Unknown};
pub use receiver::velocity_error_m_s;
pub use residuals::{Group, Residuals, Row};
pub use sensors::ACCELEROMETER_TURN_STD_S;
