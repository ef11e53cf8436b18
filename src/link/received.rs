//! Something from a link: a frame, or a change of the link itself.

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::error::ParserError;
use mavlink::{MavlinkVersion, Message};

use super::clock::HostStamp;
use super::error::LinkError;
use super::event::LinkEvent;
use crate::wire::{Frame, Header, Payload, Start, Version};

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
