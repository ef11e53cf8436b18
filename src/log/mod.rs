//! From bytes to a [`Recording`].

pub mod csv;
mod recording;

pub use recording::{Autopilot, Quantity, Recording, Stream, StreamKey};
