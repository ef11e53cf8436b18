//! One connection: its streams, its sequence numbers, what waits to be sent on it.

use std::collections::VecDeque;
use std::time::Duration;

use super::message::Message;
use super::streams::Streams;
use super::{Firmware, LinkId, LinkRole, Outgoing};
use crate::link::Signing;
use crate::wire::Splitter;

/// Parameters that go out in one loop period while the list is downloaded.
const PARAMETERS_A_LOOP: usize = 2;

/// One connection.
#[derive(Debug)]
pub(super) struct Link {
    pub(super) id: LinkId,
    pub(super) streams: Streams,
    pub(super) splitter: Splitter,
    role: LinkRole,
    sequence: u8,
    /// of a download: the next index
    next_parameter: Option<usize>,
    waiting: VecDeque<(Duration, Vec<u8>)>,
}

impl Link {
    pub(super) fn new(id: LinkId, kind: Firmware, role: LinkRole) -> Self {
        Self {
            id,
            streams: Streams::new(kind, role),
            splitter: Splitter::new(),
            role,
            sequence: 0,
            next_parameter: None,
            waiting: VecDeque::new(),
        }
    }

    /// The autopilot restarts: streams are its defaults.
    pub(super) fn restart(&mut self, kind: Firmware) {
        self.streams = Streams::new(kind, self.role);
        self.next_parameter = None;
        self.sequence = 0;
    }

    /// Queues a message for its arrival at this time.
    pub(super) fn send(
        &mut self,
        message: &Message,
        arrives: Duration,
        (system, component): (u8, u8),
        signing: Option<(&Signing, u64)>,
    ) {
        let own = signing.map(|(signing, time)| (signing.for_link(self.number()), time));
        let own = own.as_ref().map(|(signing, time)| (signing, *time));
        let frame = message.frame((self.sequence, system, component), own);
        self.sequence = self.sequence.wrapping_add(1);
        self.waiting.push_back((arrives, frame));
    }

    /// Of its signatures.
    fn number(&self) -> u8 {
        u8::try_from(self.id.0).unwrap_or(u8::MAX)
    }

    /// A frame that is lost on its way: only its sequence number is used.
    pub(super) fn lose(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
    }

    /// Passes another system's frame on as it is.
    pub(super) fn pass_on(&mut self, frame: &[u8], arrives: Duration) {
        self.waiting.push_back((arrives, frame.to_vec()));
    }

    /// PARAM_REQUEST_LIST.
    pub(super) fn start_download(&mut self) {
        self.next_parameter = Some(0);
    }

    pub(super) fn is_downloading(&self) -> bool {
        self.next_parameter.is_some()
    }

    /// Indices of the parameters that go out now, of `count`.
    pub(super) fn next_parameters(&mut self, count: usize) -> std::ops::Range<usize> {
        let Some(start) = self.next_parameter else { return 0..0 };
        let end = (start + PARAMETERS_A_LOOP).min(count);
        self.next_parameter = (end < count).then_some(end);
        start..end
    }

    /// What has arrived by now.
    pub(super) fn arrived(&mut self, now: Duration, into: &mut Vec<Outgoing>) {
        while self.waiting.front().is_some_and(|(arrives, _)| *arrives <= now) {
            if let Some((time, bytes)) = self.waiting.pop_front() {
                into.push(Outgoing { link: self.id, time, bytes });
            }
        }
    }

    /// Nothing that was on its way arrives.
    pub(super) fn drop_waiting(&mut self) {
        self.waiting.clear();
    }
}
