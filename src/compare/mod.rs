//! How well a simulation follows a recording: open loop over short windows, and in closed loop.

mod closed_loop;
mod divergence;
mod error;
mod improvement;
mod mean_square;
mod playback;

pub use closed_loop::{SIGNALS, TenSignals, autopilot_flight, recorded_tracking_m, resimulated};
pub use divergence::{Divergence, divergence};
pub use error::CompareError;
pub use improvement::improvement_percent;
pub use playback::{
    CommandNoise, Fit, FloorNoise, LengthErrors, PlaybackSettings, StateNoise, WindowErrors, playback,
    playback_lengths, playback_windows, torques_along, unchanged_windows,
};
