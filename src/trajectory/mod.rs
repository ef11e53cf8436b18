//! Reference trajectories: finite Fourier series (18)-(19) and the attitude that follows from them.

mod fourier;

pub use fourier::{FourierAxis, FourierTrajectory};
