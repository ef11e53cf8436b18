//! Errors of a flight.

use std::io;

use crate::link::{LinkError, RecordError};

/// Errors of a flight.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// the link cannot be used
    #[error(transparent)]
    Link(#[from] LinkError),
    /// the recording cannot be made
    #[error(transparent)]
    Record(#[from] RecordError),
    /// a file or thread cannot be made
    #[error("cannot make {what}: {source}")]
    Make {
        /// which
        what: String,
        /// error of the system
        source: io::Error,
    },
    /// there is no writer for the log of events
    #[error(
        "no flight without its log of events: expected a tracing subscriber with the layer mavid::fly::event_layer(), \
         found one without it, or none"
    )]
    Unheard,
    /// the program itself failed; nothing is sent any more
    #[error(
        "the flight was ended by a fault of this program; no setpoint is sent any more, and the vehicle's own \
         failsafe acts: {0}"
    )]
    Broken(String),
}
