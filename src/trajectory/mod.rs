//! Reference trajectories: finite Fourier series (18)-(19), circles (44), transitions, and the attitude
//! that follows from them.

mod attitude;
mod circle;
mod dual;
mod flight_path;
mod fourier;
mod size;

pub use attitude::{FlatMotion, Jet, Reference, flat_motion};
pub use circle::CirclePath;
pub use dual::{Dual, Scalar};
pub use flight_path::{EndState, FlightPath, Segment, Transition, at_rest, end_state};
pub use fourier::{FourierAxis, FourierTrajectory};
pub use size::{FLOWN_MAX_S, HARMONICS_MAX, PERIOD_S, SizeError, check_size};
