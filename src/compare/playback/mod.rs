//! Open loop: recorded actuators played back from measured states over short windows.

mod commands;
mod fit;
mod floor;
mod lengths;
mod measured;
mod settings;
#[cfg(test)]
mod tests;
mod torques;
mod windows;

pub use fit::{Fit, playback};
pub use floor::{CommandNoise, FloorNoise, StateNoise};
pub use lengths::{LengthErrors, playback_lengths, playback_windows};
pub use settings::PlaybackSettings;
pub use torques::torques_along;
pub use windows::{WindowErrors, unchanged_windows};
