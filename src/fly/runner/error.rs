//! Why there is no flight, or no end of it.

use std::io;

use crate::link::{LinkError, RecordError};

/// Why there was no flight, or no end of it.
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
        /// what the system said
        source: io::Error,
    },
    /// nobody would write down what happens on the flight
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
