//! Why a conversation with a vehicle failed.

use crate::fetch::{FetchError, NotesError, PartError};
use crate::link::LinkError;
use crate::wire::SystemId;

/// Why a conversation with a vehicle failed.
#[derive(Debug, thiserror::Error)]
pub enum OnboardError {
    /// the link cannot be opened, or is lost
    #[error(transparent)]
    Link(#[from] LinkError),
    /// the vehicles on the link are not the one that is meant
    #[error("{0}")]
    Refused(String),
    /// no vehicle was heard
    #[error("{address}: expected a HEARTBEAT of a vehicle within {within_s} s, heard {heard}")]
    Absent {
        /// of the link
        address: String,
        /// how long it was waited for
        within_s: u64,
        /// who was heard in its place
        heard: String,
    },
    /// it is armed where its parameters are to be set
    #[error(
        "system {0} is armed: its parameters are set while it is disarmed alone. Land and disarm it, then give the same command \
         again"
    )]
    Armed(SystemId),
    /// it does not say whether it is armed
    #[error(
        "system {system}: expected a HEARTBEAT within {within_s} s that says that it is disarmed, none came: nothing is set. Give \
         the same command again on a better link"
    )]
    Silent {
        /// the vehicle
        system: SystemId,
        /// how long it was listened for
        within_s: u64,
    },
    /// a signal ended it
    #[error("ended by {0}")]
    Ended(String),
    /// a signal ended a download
    #[error(
        "ended by {signal}; {kept} of {of} bytes are kept, and the next download into the same folder goes on with them"
    )]
    DownloadEnded {
        /// the signal
        signal: String,
        /// bytes that came
        kept: u64,
        /// bytes of the log
        of: u64,
    },
    /// a dialogue failed
    #[error(transparent)]
    Dialogue(#[from] FetchError),
    /// the file of a log
    #[error(transparent)]
    Part(#[from] PartError),
    /// the notes of what was changed on a vehicle
    #[error(transparent)]
    Notes(#[from] NotesError),
    /// it answered for none of these parameters
    #[error("expected an answer for {}, the vehicle gave none", .0.join(", "))]
    Unanswered(Vec<&'static str>),
    /// parameters were not set
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    NotSet(Vec<FetchError>),
}

impl OnboardError {
    /// What was asked for cannot be: another vehicle, folder or address has to be given.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Link(LinkError::Unavailable { .. })
                | Self::Refused(_)
                | Self::Dialogue(FetchError::NoTarget(_))
                | Self::Part(PartError::Another { .. } | PartError::Taken { .. })
        )
    }

    /// A signal asked for the end.
    #[must_use]
    pub fn is_end(&self) -> bool {
        matches!(self, Self::Ended(_) | Self::DownloadEnded { .. })
    }
}
