//! Reference trajectories: finite Fourier series (18)-(19) and the attitude that follows from them.

mod attitude;
mod dual;
mod fourier;

pub use attitude::{FlatMotion, Jet, Reference, flat_motion};
pub use dual::{Dual, Scalar};
pub use fourier::{FourierAxis, FourierTrajectory};
