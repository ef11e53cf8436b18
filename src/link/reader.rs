//! The half of a link that hears.

use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::error::ParserError;
use mavlink::{MavlinkVersion, Message};
use tokio::sync::mpsc;

use super::clock::HostStamp;
use super::error::LinkError;
use super::shared::{Alive, Shared};
use super::signing::Distrust;
use super::stats::LinkStats;
use crate::log::{ComponentId, Frame, Header, Payload, Start, SystemId, Version};

/// Something from a link.
#[derive(Debug, Clone, PartialEq)]
pub enum Received {
    /// a frame
    Frame(ReceivedFrame),
    /// the link itself changed
    Event(LinkEvent),
}

/// One whole frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceivedFrame {
    /// when its last bytes were read, taken before anything looked at them
    pub stamp: HostStamp,
    /// what its header says
    pub header: Header,
    bytes: Box<[u8]>,
}

impl ReceivedFrame {
    pub(super) fn new(stamp: HostStamp, frame: Frame<'_>) -> Self {
        Self { stamp, header: *frame.header(), bytes: frame.bytes().into() }
    }

    /// The whole frame as it was received.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Its payload, to be read by byte offset: independent of enum values that the dialect does not know.
    #[must_use]
    pub fn payload(&self) -> Payload<'_> {
        Frame::at_start(&self.bytes).map_or(Payload(&[]), |frame| frame.payload())
    }

    /// The message as the dialect's struct.
    ///
    /// # Errors
    /// The dialect does not know the message or one of its enum values. What flight safety rests on (mode
    /// and arming of a HEARTBEAT) is to be read from [`payload`](Self::payload) instead.
    pub fn message(&self) -> Result<MavMessage, ParserError> {
        let version = match self.header.version {
            Version::V1 => MavlinkVersion::V1,
            Version::V2 => MavlinkVersion::V2,
        };
        MavMessage::parse(version, self.header.message_id, self.payload().0)
    }

    /// A frame that was not received by a link: for tests and players.
    ///
    /// # Errors
    /// `bytes` are not one whole frame.
    pub fn from_bytes(stamp: HostStamp, bytes: &[u8]) -> Result<Self, LinkError> {
        match (Header::read(bytes), Frame::at_start(bytes)) {
            (Start::Header(_), Some(frame)) if frame.bytes().len() == bytes.len() => {
                Ok(Self::new(stamp, frame))
            }
            _ => Err(LinkError::NotAFrame { bytes: bytes.len() }),
        }
    }
}

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
    /// the recording goes on
    RecordingGoesOn,
}

impl fmt::Display for LinkEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Waiting { why } => write!(f, "nobody at the other end yet ({why}): it is tried again"),
            Self::Connected { peer } => write!(f, "connected to {peer}"),
            Self::Lost { why } => write!(f, "lost: {why}"),
            Self::Restored { peer } => write!(f, "connected again to {peer}"),
            Self::Stranger { peer } => write!(f, "{peer} sends here too; it is neither heard nor recorded"),
            Self::Trusted { system, component } => {
                write!(f, "system {system} component {component} signs with the key given")
            }
            Self::Distrusted { system, component, why } => {
                write!(f, "system {system} component {component} is not believed: {why}")
            }
            Self::Unchecked { system, component } => write!(
                f,
                "system {system} component {component} signs its messages, and no key was given: nothing proves that \
                 they are its own, and it may not believe what it is sent; give its key by --signing-key-file"
            ),
            Self::ClockBehind { seconds } => write!(
                f,
                "what is heard is signed {seconds} s ahead of this computer's clock, expected at most 60 s: set this \
                 computer's clock, or the vehicle's"
            ),
            Self::RecordingFails => f.write_str("the disk does not take the recording"),
            Self::RecordingGoesOn => f.write_str("the recording goes on"),
        }
    }
}

/// The half of a link that hears. It cannot send: a link without a [`LinkWriter`](super::LinkWriter), as a
/// replay is one, carries no commands.
#[derive(Debug)]
pub struct LinkReader {
    from: mpsc::UnboundedReceiver<Received>,
    shared: Arc<Shared>,
    _alive: Option<Alive>,
}

impl LinkReader {
    pub(super) fn new(
        from: mpsc::UnboundedReceiver<Received>,
        shared: Arc<Shared>,
        alive: Option<Alive>,
    ) -> Self {
        Self { from, shared, _alive: alive }
    }

    /// The next frame or event, in the order of arrival. Cancel-safe: nothing is lost where the future is
    /// dropped.
    ///
    /// # Errors
    /// The link has ended.
    pub async fn receive(&mut self) -> Result<Received, LinkError> {
        let received = self.from.recv().await.ok_or(LinkError::Closed)?;
        self.shared.waiting.fetch_sub(1, Ordering::Relaxed);
        Ok(received)
    }

    /// What is there already, `None` where nothing waits.
    ///
    /// # Errors
    /// The link has ended.
    pub fn try_receive(&mut self) -> Result<Option<Received>, LinkError> {
        match self.from.try_recv() {
            Ok(received) => {
                self.shared.waiting.fetch_sub(1, Ordering::Relaxed);
                Ok(Some(received))
            }
            Err(mpsc::error::TryRecvError::Empty) => Ok(None),
            Err(mpsc::error::TryRecvError::Disconnected) => Err(LinkError::Closed),
        }
    }

    /// Frames and events that wait to be taken.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.shared.waiting.load(Ordering::Relaxed)
    }

    /// Where a `udpin` or `tcpin` link listens: the port that the system chose where the address said 0.
    #[must_use]
    pub fn local_address(&self) -> Option<SocketAddr> {
        self.shared.local
    }

    /// What passed the link so far.
    #[must_use]
    pub fn stats(&self) -> LinkStats {
        self.shared.stats().clone()
    }

    /// Whether there is somebody to send to. UDP cannot know whether anybody is there.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.shared.open.load(Ordering::Acquire)
    }
}
