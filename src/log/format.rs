//! What a format of logs is to the rest of the program.

use super::error::LogError;
use super::input::Input;
use super::options::OpenOptions;
use super::report::ReadReport;
use crate::recording::{Event, RecordingBuilder};

/// A format of logs: how a file of it is told from others, and how it is read.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// as messages call it, with the usual ending of its files' names: `telemetry log (.tlog)`
    pub name: &'static str,
    /// usual ending of its files' names, without the dot: by it logs are found in a folder. What a file is, its content tells
    pub ending: &'static str,
    /// uses [`OpenOptions::system`]: a log may hold several vehicles
    pub takes_system: bool,
    /// uses [`OpenOptions::columns`]: a table, whose rows may come in any order
    pub takes_columns: bool,
    /// looks at the first bytes of a file, a megabyte or all there are, and says whether it is of this format
    pub sniff: fn(&[u8]) -> Option<Certainty>,
    /// reads a log and gives each piece of the flight to the sink as it comes, in memory that does not grow with the log.
    /// What the file holds and cannot be given is counted in the report
    pub read: fn(&Input<'_>, &OpenOptions, &mut Sink<'_>) -> Result<ReadReport, LogError>,
    /// adds the same to a recording, sooner; `None` where `read` does it
    pub read_whole: Option<ReadWhole>,
}

/// Reads a log into a recording.
pub type ReadWhole = fn(&Input<'_>, &OpenOptions, &mut RecordingBuilder) -> Result<ReadReport, LogError>;

/// How sure a format is that a file is of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Certainty {
    /// other formats look the same: it is of this one if it is of no other
    Possible,
    /// a signature, or structure that no other format has
    Certain,
}

/// Takes the pieces of a flight with their places in the log.
pub type Sink<'a> = dyn FnMut(Place, Event<'_>) + 'a;

/// Where in a log an event was met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// byte offset in the file
    pub offset: u64,
    /// when the recording computer received it, microseconds since 1970 UTC; `None` where that is not logged, or where the
    /// event's own time was made from it
    pub arrival_us: Option<u64>,
}
