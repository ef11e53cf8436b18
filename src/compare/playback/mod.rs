//! Open loop: recorded actuators played back from measured states over short windows.

mod commands;
mod fit;
mod floor;
mod measured;
mod settings;
#[cfg(test)]
mod tests;
mod torques;
mod windows;

pub use fit::{Fit, playback};
pub use floor::{CommandNoise, StateNoise, playback_floor};
pub use settings::PlaybackSettings;
pub use torques::torques_along;
pub use windows::{WindowErrors, playback_windows, unchanged_windows};
