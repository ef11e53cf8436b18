//! From bytes to frames and events for the reader.

use crate::wire::message_id::HEARTBEAT;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use tokio::sync::mpsc;

use super::clock::{HostClock, HostStamp};
use super::event::LinkEvent;
use super::options::LinkOptions;
use super::received::{Received, ReceivedFrame};
use super::recorder::Recorder;
use super::shared::Shared;
use super::signing::{ReportedSignatures, Signing};
use crate::wire::{Frame, Splitter};

/// Frames that may wait for the reader; further ones are counted, not delivered.
pub(super) const WAITING: usize = 1 << 14;

/// From bytes to frames and events for the reader.
#[derive(Debug)]
pub(super) struct Incoming {
    splitter: Splitter,
    sink: Sink,
    was_connected: bool,
    /// what was last said while nobody was at the other end
    waits_for: Option<String>,
}

/// Where frames go.
#[derive(Debug)]
struct Sink {
    to_reader: mpsc::UnboundedSender<Received>,
    shared: Arc<Shared>,
    clock: HostClock,
    signing: Option<Signing>,
    signatures: ReportedSignatures,
    recorder: Option<Recorder>,
    recording_fails: bool,
}

impl Incoming {
    pub fn new(
        to_reader: mpsc::UnboundedSender<Received>,
        shared: Arc<Shared>,
        options: &LinkOptions,
    ) -> Self {
        let sink = Sink {
            to_reader,
            shared,
            clock: options.clock,
            signing: options.signing.clone(),
            signatures: ReportedSignatures::default(),
            recorder: options.recorder.clone(),
            recording_fails: false,
        };
        Self { splitter: Splitter::new(), sink, was_connected: false, waits_for: None }
    }

    /// The present moment: to be taken as soon as bytes are there.
    pub fn now(&self) -> HostStamp {
        self.sink.clock.now()
    }

    /// The clock, for a thread that reads.
    pub fn clock(&self) -> HostClock {
        self.sink.clock
    }

    /// Bytes of a stream.
    pub fn bytes(&mut self, bytes: &[u8], stamp: HostStamp) {
        self.splitter.feed(bytes);
        self.take(bytes.len(), stamp);
    }

    /// A datagram: frames do not continue in the next. Whether there was a HEARTBEAT in it that may be believed.
    pub fn datagram(&mut self, bytes: &[u8], stamp: HostStamp) -> bool {
        self.splitter.feed(bytes);
        self.splitter.flush();
        self.take(bytes.len(), stamp)
    }

    /// The stream is silent: what waits for its continuation is decided.
    pub fn silence(&mut self, stamp: HostStamp) {
        self.splitter.flush();
        self.take(0, stamp);
    }

    fn take(&mut self, bytes: usize, stamp: HostStamp) -> bool {
        let mut heartbeat = false;
        while let Some(frame) = self.splitter.next_frame() {
            heartbeat |= self.sink.accept(&frame, stamp) && frame.header().message_id == HEARTBEAT;
        }
        let mut stats = self.sink.shared.stats();
        stats.received_bytes += bytes as u64;
        stats.take_over(self.splitter.counts());
        heartbeat
    }

    /// Whether the writer takes frames.
    pub fn open(&mut self, open: bool) {
        self.sink.shared.open.store(open, Ordering::Release);
    }

    /// Somebody is at the other end.
    pub fn connected(&mut self, peer: String) {
        self.open(true);
        let event =
            if self.was_connected { LinkEvent::Restored { peer } } else { LinkEvent::Connected { peer } };
        self.was_connected = true;
        self.sink.deliver(Received::Event(event));
    }

    /// Nobody is at the other end yet: said once for each reason, and not after a loss, which is said already.
    pub fn waiting(&mut self, why: String) {
        if !self.was_connected && self.waits_for.as_ref() != Some(&why) {
            self.waits_for = Some(why.clone());
            self.sink.deliver(Received::Event(LinkEvent::Waiting { why }));
        }
    }

    /// Nobody is at the other end any more. Half a frame from before does not continue with what comes after.
    pub fn lost(&mut self, why: String) {
        self.open(false);
        let stamp = self.now();
        self.silence(stamp);
        self.sink.shared.stats().losses += 1;
        self.sink.deliver(Received::Event(LinkEvent::Lost { why }));
    }

    /// Somebody else sends here.
    pub fn stranger(&mut self, peer: String) {
        self.sink.deliver(Received::Event(LinkEvent::Stranger { peer }));
    }

    /// Datagrams of somebody else are dropped.
    pub fn count_stranger(&mut self) {
        self.sink.shared.stats().stranger_datagrams += 1;
    }
}

impl Sink {
    /// Records, counts and delivers a frame. Whether it is proven: of a known message, and signed where that
    /// is asked.
    fn accept(&mut self, frame: &Frame<'_>, stamp: HostStamp) -> bool {
        self.record(frame, stamp);
        self.shared.stats().tally(frame);
        let verdict = self.signing.as_ref().map_or(Ok(()), |signing| signing.verify(frame));
        for event in self.signatures.events(frame, self.signing.as_ref(), verdict) {
            self.deliver(Received::Event(event));
        }
        if let Err(distrust) = verdict {
            self.shared.stats().count(distrust);
            return false;
        }
        if self.shared.waiting.load(Ordering::Relaxed) < WAITING {
            self.deliver(Received::Frame(ReceivedFrame::new(stamp, *frame)));
        } else {
            self.shared.stats().undelivered += 1;
        }
        true
    }

    fn record(&mut self, frame: &Frame<'_>, stamp: HostStamp) {
        let Some(recorder) = &self.recorder else { return };
        let fails = !recorder.record(stamp, frame);
        if std::mem::replace(&mut self.recording_fails, fails) != fails {
            let event = if fails { LinkEvent::RecordingFails } else { LinkEvent::RecordingGoesOn };
            self.deliver(Received::Event(event));
        }
    }

    /// A reader that is gone misses nothing.
    fn deliver(&self, received: Received) {
        self.shared.waiting.fetch_add(1, Ordering::Relaxed);
        let _ = self.to_reader.send(received);
    }
}
