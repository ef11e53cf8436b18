//! What gives messages their sequence numbers and signatures, and sends one at once where nothing is before it.
//!
//! A message that goes through the link's task leaves when the system runs that task, which on a busy machine is
//! milliseconds later. Whoever sends in time itself has a way past it, over sockets that take a datagram whole.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use tokio::net::UdpSocket;
use tokio::sync::mpsc;

use super::clock::{HostClock, HostStamp};
use super::options::LinkOptions;
use super::recorder::Recorder;
use super::signing::Signing;
use crate::wire::{ComponentId, Frame, SystemId};

/// What takes datagrams from any thread.
#[derive(Debug, Clone)]
pub(super) enum Direct {
    /// a socket, and whom it sends to: `None` where it has one peer alone
    Socket(Arc<UdpSocket>, Option<SocketAddr>),
    /// who carries the bytes of a link without a transport
    Carried(mpsc::UnboundedSender<Box<[u8]>>),
}

impl Direct {
    fn try_send(&self, frame: &[u8]) -> io::Result<usize> {
        match self {
            Self::Socket(socket, Some(to)) => socket.try_send_to(frame, *to),
            Self::Socket(socket, None) => socket.try_send(frame),
            Self::Carried(to) => match to.send(frame.into()) {
                Ok(()) => Ok(frame.len()),
                Err(_) => Err(io::ErrorKind::NotConnected.into()),
            },
        }
    }
}

/// Serialises messages in the order in which they are sent.
#[derive(Debug)]
pub(super) struct Pen {
    system: SystemId,
    component: ComponentId,
    sequence: u8,
    clock: HostClock,
    signing: Option<Signing>,
    recorder: Option<Recorder>,
    /// the task has a frame in its hands that is not told as sent or failed
    pub in_flight: bool,
    /// the way past the task, while there is one
    pub direct: Option<Direct>,
}

impl Pen {
    pub fn new(options: &LinkOptions) -> Self {
        Self {
            system: options.system,
            component: options.component,
            sequence: 0,
            clock: options.clock,
            signing: options.signing.clone(),
            recorder: options.recorder.clone(),
            in_flight: false,
            direct: None,
        }
    }

    /// The message as the link's next frame.
    pub fn write(&mut self, message: &MavMessage) -> Box<[u8]> {
        let header =
            MavHeader { system_id: self.system.0, component_id: self.component.0, sequence: self.sequence };
        self.sequence = self.sequence.wrapping_add(1);
        let mut raw = MAVLinkV2MessageRaw::new();
        let Some(signing) = &self.signing else {
            raw.serialize_message(header, message);
            return raw.raw_bytes().into();
        };
        raw.serialize_message_for_signing(header, message);
        let mut bytes: Box<[u8]> = raw.raw_bytes().into();
        signing.sign(&mut bytes);
        bytes
    }

    /// Sends a message at once and records it; bytes sent. `None` where it has to go through the task: nothing of it was
    /// sent, and its sequence number is not used.
    pub fn send_now(&mut self, message: &MavMessage) -> Option<usize> {
        let direct = self.direct.clone().filter(|_| !self.in_flight)?;
        let sequence = self.sequence;
        let frame = self.write(message);
        let stamp = self.now();
        if direct.try_send(&frame).is_err() {
            // what is wrong with the socket is for the task to find out
            self.sequence = sequence;
            return None;
        }
        self.record(stamp, &frame);
        Some(frame.len())
    }

    /// The present moment: to be taken when a frame is handed to the system.
    pub fn now(&self) -> HostStamp {
        self.clock.now()
    }

    /// A frame went out.
    pub fn record(&self, stamp: HostStamp, frame: &[u8]) {
        if let (Some(recorder), Some(frame)) = (&self.recorder, Frame::at_start(frame)) {
            // a failing recording is told by what comes in
            let _ = recorder.record(stamp, &frame);
        }
    }
}
