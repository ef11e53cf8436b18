//! From a file to a [`Recording`](crate::recording::Recording).
//!
//! ```text
//! TlogReader -> Decoder -> events -> RecordingBuilder -> Recording
//! ```
//!
//! [`load`] does all of it; [`stream_tlog`] gives the events to whoever wants them without keeping any.

mod builder;
pub mod csv;
mod error;
mod flights;
mod flown;
mod load;
mod report;
mod tlog;

pub use builder::RecordingBuilder;
pub use error::LogError;
pub use flights::{Flights, Hold, LogFlight};
pub use flown::who_flew;
pub use load::{LoadOptions, Loaded, LoadedFlights, Place, TlogWalk, Walk, load, load_flights, stream_tlog};
pub use report::{ReadReport, Resync, StreamRepair};
pub use tlog::TlogReader;
