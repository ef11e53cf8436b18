//! A change of a link itself.

use std::fmt;

use tracing::{info, warn};

use super::signing::Distrust;
use crate::wire::{ComponentId, SystemId};

/// A change of the link itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LinkEvent {
    /// nobody is at the other end yet; the link tries again by itself
    Waiting {
        /// what the last try came to
        why: String,
    },
    /// somebody is at the other end, for the first time
    Connected {
        /// who
        peer: String,
    },
    /// nobody is at the other end any more; the link tries again by itself
    Lost {
        /// what happened
        why: String,
    },
    /// somebody is at the other end again
    Restored {
        /// who
        peer: String,
    },
    /// somebody else sends to this address; what they send is counted and dropped
    Stranger {
        /// who
        peer: String,
    },
    /// the first frame of a sender that is signed with our key
    Trusted {
        /// its system
        system: SystemId,
        /// its component
        component: ComponentId,
    },
    /// the first frame of a sender that is not believed, for this reason
    Distrusted {
        /// its system
        system: SystemId,
        /// its component
        component: ComponentId,
        /// why it is not believed
        why: Distrust,
    },
    /// a sender signs, and there is no key to check it by
    Unchecked {
        /// its system
        system: SystemId,
        /// its component
        component: ComponentId,
    },
    /// signing times of others are ahead of this computer's clock
    ClockBehind {
        /// s
        seconds: u64,
    },
    /// the recording misses frames, or its file cannot be written now
    RecordingFails,
    /// the recording continues
    RecordingGoesOn,
}

impl LinkEvent {
    /// Emits it as a tracing event with its fields.
    pub(super) fn emit(&self) {
        match self {
            Self::Waiting { why } => info!(why, "link waits for its other end"),
            Self::Connected { peer } => info!(peer, "link connected"),
            Self::Lost { why } => warn!(why, "link lost"),
            Self::Restored { peer } => info!(peer, "link restored"),
            Self::Stranger { peer } => warn!(peer, "link heard a stranger"),
            Self::Trusted { system, component } => {
                info!(system = system.0, component = component.0, "signature trusted");
            }
            Self::Distrusted { system, component, why } => {
                warn!(system = system.0, component = component.0, %why, "signature distrusted");
            }
            Self::Unchecked { system, component } => {
                warn!(system = system.0, component = component.0, "signature not checked");
            }
            Self::ClockBehind { seconds } => warn!(seconds, "clock behind those of others"),
            Self::RecordingFails => warn!("recording fails"),
            Self::RecordingGoesOn => info!("recording goes on"),
        }
    }
}

impl fmt::Display for LinkEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Waiting { why } => write!(f, "no peer yet ({why}): trying again"),
            Self::Connected { peer } => write!(f, "connected to {peer}"),
            Self::Lost { why } => write!(f, "lost: {why}"),
            Self::Restored { peer } => write!(f, "connected again to {peer}"),
            Self::Stranger { peer } => write!(f, "{peer} also sends here; it is ignored and not recorded"),
            Self::Trusted { system, component } => {
                write!(f, "system {system} component {component} signs with the key given")
            }
            Self::Distrusted { system, component, why } => {
                write!(f, "system {system} component {component} is not accepted: {why}")
            }
            Self::Unchecked { system, component } => write!(
                f,
                "system {system} component {component} signs its messages, but no key was given: their origin is not \
                 verified, and the vehicle may ignore what it is sent; give its key by --signing-key-file"
            ),
            Self::ClockBehind { seconds } => write!(
                f,
                "received messages are signed {seconds} s ahead of this computer's clock, expected at most 60 s: set \
                 this \
                 computer's clock, or the vehicle's"
            ),
            Self::RecordingFails => f.write_str("the disk does not accept the recording"),
            Self::RecordingGoesOn => f.write_str("the recording goes on"),
        }
    }
}
