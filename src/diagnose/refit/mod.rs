//! Rigid body and effects refitted together by multiple shooting: the model is simulated over short segments,
//! each from a free initial state, and compared with the measured velocity, attitude and rates.
//!
//! It rests on other equations than the weak form (simulation, not integrals of measured derivatives; no
//! accelerometer), so that its agreement with it is a check. It shares the weak form's regressors for
//! nothing but the start.
//!
//! It is a check, not the estimate: its rotor torques are the logged commands, whose jitter acts as noise on
//! the right-hand side and makes inertia some percent too large, which the weak form, with the commands on
//! the left, avoids. Lags, heights and other nonlinear parameters it finds as well or better.

mod error;
mod parameters;
mod result;
mod segments;
mod settings;
mod shooting;
mod solve;

pub use error::RefitError;
pub use result::{Refit, Refitted};
pub use settings::RefitSettings;
pub use shooting::refit;
