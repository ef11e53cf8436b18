//! The vehicle's parameters as far as a flight needs them: those that turn actuator outputs into thrust,
//! those that govern failsafes, and the limits that the autopilot puts on a trajectory.

mod bitmask;
mod download;
mod failsafe;
mod failsafe_ardupilot;
mod failsafe_px4;
mod fence_switch;
mod names;
mod parameter_set;
mod sentence;
mod takeover;

pub(super) use bitmask::has_bit;
pub use download::{Download, DownloadSettings, Progress};
pub use failsafe::failsafe_declaration;
pub(super) use failsafe_ardupilot::hears_station;
pub(super) use fence_switch::FenceSwitch;
pub use names::{RequestedParameter, requested_parameters};
pub use parameter_set::{Parameters, ParametersError};
pub use sentence::Sentence;
pub use takeover::takeover_declaration;
