//! From a file of any known format to a [`Recording`](crate::recording::Recording).
//!
//! ```text
//! Input -> Format (told by content) -> events -> RecordingBuilder -> Recording
//! ```
//!
//! [`open`] does all of it. [`open_flights`] divides a log into flights of bounded size. [`stream`] gives the events to
//! whoever wants them without keeping any.

pub mod csv;
mod dataflash;
mod date;
mod error;
mod flights;
mod foreign;
mod format;
#[cfg(test)]
mod heights_tests;
mod input;
mod leap;
mod lookahead;
mod loss;
mod onboard;
mod open;
mod options;
mod report;
mod tlog;
pub mod ulog;

pub use dataflash::{
    ARRAY_VALUES, DataflashDamage, DataflashReader, DataflashTextReader, Definition, Definitions, Field,
    Letter, Message,
};
pub use error::LogError;
pub use flights::{Flights, Hold, LogFlight, SILENCE_S};
pub use format::{Certainty, Format, Place, ReadWhole, Sink};
pub use input::Input;
pub use loss::{Loss, Oddity, Position, RowRejection};
pub use onboard::{OnboardReport, Topic};
pub use open::{
    FORMATS, Opened, OpenedFlights, expect_file, format_of, is_named_like_a_log, open, open_flights, stream,
};
pub use options::OpenOptions;
pub use report::{Details, ReadReport};
pub use tlog::{Resync, TlogReader, TlogReport};
