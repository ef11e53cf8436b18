//! A flight as typed streams on the vehicle's own clock, whatever it was read from.

mod flight;
mod overlap;
mod statistics;

pub use flight::{Quantity, Recording, Stream, StreamKey};
pub use overlap::shared_share;
pub use statistics::{StreamStats, StreamTally};
