//! A flight as typed streams on the vehicle's own clock, whatever it was read from.
//!
//! ```text
//! reader of a log, or decoder of a link -> Event -> RecordingBuilder -> Recording
//! ```

mod builder;
mod event;
mod flight;
mod growing;
pub mod landed;
mod leaps;
mod overlap;
mod quantity;
mod statistics;
mod stream;
mod value_range;

pub use builder::RecordingBuilder;
pub use event::Event;
pub use flight::{ParameterChange, Recording};
pub use growing::{Growing, StreamRepair};
pub use overlap::Overlap;
pub use quantity::Quantity;
pub use statistics::{LEAST_SAMPLES, LEAST_SPAN_S, StreamStats, StreamTally};
pub use stream::{Stream, StreamKey};
