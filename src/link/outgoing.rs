//! From messages and frames to the bytes that are sent next.

use std::collections::VecDeque;
use std::sync::Arc;

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use tokio::sync::{mpsc, oneshot};

use super::clock::{HostClock, HostStamp};
use super::open::LinkOptions;
use super::recorder::Recorder;
use super::shared::Shared;
use super::signing::Signing;
use crate::log::{ComponentId, Frame, SystemId};

/// Something for the ordered queue.
#[derive(Debug)]
pub(super) enum Item {
    /// to be sent as it is
    Frame(Box<[u8]>),
    /// to be given its sequence number when it is sent
    Message(Box<MavMessage>),
    /// to be answered when all before is sent
    Barrier(oneshot::Sender<()>),
}

/// From messages and frames to the bytes that are sent next.
#[derive(Debug)]
pub(super) struct Outgoing {
    queue: mpsc::Receiver<Item>,
    shared: Arc<Shared>,
    system: SystemId,
    component: ComponentId,
    clock: HostClock,
    signing: Option<Signing>,
    recorder: Option<Recorder>,
    sequence: u8,
    /// the last frame came from the slot: the queue has its turn
    queue_first: bool,
    /// a frame was given out and not yet told as sent or failed
    in_flight: bool,
    /// the other end was lost and is not back
    lost: bool,
    barriers: VecDeque<oneshot::Sender<()>>,
}

impl Outgoing {
    pub fn new(queue: mpsc::Receiver<Item>, shared: Arc<Shared>, options: &LinkOptions) -> Self {
        Self {
            queue,
            shared,
            system: options.system,
            component: options.component,
            clock: options.clock,
            signing: options.signing.clone(),
            recorder: options.recorder.clone(),
            sequence: 0,
            queue_first: false,
            in_flight: false,
            lost: false,
            barriers: VecDeque::new(),
        }
    }

    /// The next frame to send; the one before is sent when this is called. Cancel-safe: nothing is taken
    /// before it returns.
    pub async fn next(&mut self) -> Box<[u8]> {
        let bytes = loop {
            match self.pick().await {
                Item::Frame(bytes) => break bytes,
                Item::Message(message) => break self.serialise(&message),
                Item::Barrier(done) => self.barriers.push_back(done),
            }
        };
        self.in_flight = true;
        bytes
    }

    /// The slot and the queue take turns, so that neither starves the other.
    async fn pick(&mut self) -> Item {
        loop {
            if self.queue_first {
                self.queue_first = false;
                if let Ok(item) = self.queue.try_recv() {
                    return item;
                }
            }
            if let Some(message) = self.shared.latest().take() {
                self.queue_first = true;
                return Item::Message(message);
            }
            if let Ok(item) = self.queue.try_recv() {
                return item;
            }
            self.answer_barriers();
            tokio::select! {
                item = self.queue.recv() => match item {
                    Some(item) => return item,
                    None => {
                        self.shared.drained.notify_one();
                        std::future::pending::<()>().await;
                    }
                },
                () = self.shared.filled.notified() => {}
            }
        }
    }

    /// Slot and queue are empty and the last frame is sent.
    fn answer_barriers(&mut self) {
        for done in self.barriers.drain(..) {
            let _ = done.send(());
        }
    }

    fn serialise(&mut self, message: &MavMessage) -> Box<[u8]> {
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

    /// The present moment: to be taken when a frame is handed to the system.
    pub fn now(&self) -> HostStamp {
        self.clock.now()
    }

    /// A frame went out.
    pub fn sent(&mut self, frame: &[u8], stamp: HostStamp) {
        self.in_flight = false;
        if let (Some(recorder), Some(frame)) = (&self.recorder, Frame::at_start(frame)) {
            // a failing recording is told by what comes in
            let _ = recorder.record(stamp, &frame);
        }
        let mut stats = self.shared.stats();
        stats.sent_frames += 1;
        stats.sent_bytes += frame.len() as u64;
    }

    /// A frame did not go out.
    pub fn failed(&mut self) {
        self.in_flight = false;
        self.shared.stats().unsent += 1;
    }

    /// Somebody is at the other end. What was given before a loss, but came behind it, is forgotten too.
    pub fn connected(&mut self) {
        if self.lost {
            self.discard();
            self.lost = false;
        }
    }

    /// Forgets what waits: nothing old may reach a vehicle that comes back.
    pub fn discard(&mut self) {
        self.lost = true;
        let mut unsent = u64::from(self.shared.latest().take().is_some());
        unsent += u64::from(std::mem::take(&mut self.in_flight));
        while let Ok(item) = self.queue.try_recv() {
            match item {
                Item::Barrier(done) => self.barriers.push_back(done),
                Item::Frame(_) | Item::Message(_) => unsent += 1,
            }
        }
        self.answer_barriers();
        self.shared.stats().unsent += unsent;
    }
}
