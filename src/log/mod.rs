//! From bytes to a [`Recording`].
//!
//! ```text
//! bytes -> Splitter (a link) or TlogReader (a file) -> Decoder -> events -> RecordingBuilder -> Recording
//! ```
//!
//! [`load`] does all of it; [`stream_tlog`] gives the events to whoever wants them without keeping any.

mod builder;
mod clock;
mod crc;
pub mod csv;
mod decode;
mod embedded;
mod error;
mod flights;
mod flown;
mod frame;
mod load;
mod overlap;
mod recording;
mod report;
mod splitter;
mod stats;
mod tlog;

pub use self::crc::{CrcSeeds, checksum};
pub use builder::RecordingBuilder;
pub use clock::{Anchor, Stamp};
pub use decode::{DecodeReport, Decoder, Event, Source, StreamId, Vehicle};
pub use embedded::{EMBEDDED_UID2, Nonce};
pub use error::LogError;
pub use flights::{Flights, Hold, LogFlight};
pub use flown::who_flew;
pub use frame::{
    Check, ComponentId, Frame, Header, MARKER_V1, MARKER_V2, MAX_FRAME_BYTES, Payload, Start, SystemId,
    Version,
};
pub use load::{LoadOptions, Loaded, LoadedFlights, Place, TlogWalk, Walk, load, load_flights, stream_tlog};
pub use overlap::shared_share;
pub use recording::{Quantity, Recording, Stream, StreamKey};
pub use report::{MessageCounts, ReadReport, Resync, Sender, StreamRepair};
pub use splitter::{SplitCounts, Splitter};
pub use stats::{StreamStats, StreamTally};
pub use tlog::{ByteOrder, MessageWriter, Record, STAMP_BYTES, TlogReader, TlogWriter, write_recording};
