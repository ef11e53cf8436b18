//! From bytes to a [`Recording`].

mod recording;

pub use recording::{Autopilot, Quantity, Recording, Stream, StreamKey};
