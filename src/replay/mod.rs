//! Plays a recorded flight back at the pace of its stamps.

mod counts;
mod error;
mod player;
mod telemetry;

pub use counts::{HeldBack, ReplayCounts};
pub use error::ReplayError;
pub use player::Replay;
