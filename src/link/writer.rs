//! The half of a link that speaks.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use mavlink::dialects::ardupilotmega::MavMessage;
use tokio::sync::{mpsc, oneshot};
use tokio::time::timeout;

use super::error::LinkError;
use super::given::Given;
use super::outgoing::Item;
use super::shared::{Alive, Shared};
use super::stats::LinkStats;
use crate::wire::Frame;

/// How often a flush looks whether the link was lost meanwhile.
const LOOK: Duration = Duration::from_millis(100);

/// The half of a link that speaks. Clones share the link, its queue and its sequence numbers.
///
/// Sending never waits: what cannot be sent now is refused. `Ok` means that it was queued; frames that the
/// link's loss overtakes are counted as [`LinkStats::unsent`].
#[derive(Debug, Clone)]
pub struct LinkWriter {
    queue: mpsc::Sender<Item>,
    shared: Arc<Shared>,
    _alive: Alive,
}

impl LinkWriter {
    pub(super) fn new(queue: mpsc::Sender<Item>, shared: Arc<Shared>, alive: Alive) -> Self {
        Self { queue, shared, _alive: alive }
    }

    /// Queues one whole frame, to be sent byte for byte as it is: its sequence number and its signature are
    /// the caller's business.
    ///
    /// # Errors
    /// `frame` is not one whole frame, nobody is at the other end, too much waits already, or the link has
    /// ended.
    pub fn send(&self, frame: &[u8]) -> Result<(), LinkError> {
        match Frame::at_start(frame) {
            Some(whole) if whole.bytes().len() == frame.len() => self.queue(Item::Frame(frame.into())),
            _ => Err(LinkError::NotAFrame { bytes: frame.len() }),
        }
    }

    /// Queues a message. It gets the link's system, component and next sequence number when it is sent. One that has waited
    /// for 100 ms by then is not sent, and counted as [`LinkStats::unsent`].
    ///
    /// # Errors
    /// Nobody is at the other end, too much waits already, or the link has ended.
    pub fn send_message(&self, message: &MavMessage) -> Result<(), LinkError> {
        self.queue(Item::Message(Given::now(message)))
    }

    /// Puts a message of which only the latest matters, as a setpoint is, into a slot of its own: one that
    /// waits there already is replaced. The slot and the queue take turns. Over UDP, where nothing waits, the
    /// calling thread itself sends it.
    ///
    /// # Errors
    /// Nobody is at the other end, or the link has ended.
    pub fn send_latest(&self, message: &MavMessage) -> Result<(), LinkError> {
        self.check()?;
        if self.send_now(message) {
            return Ok(());
        }
        let replaced = self.shared.latest().replace(Given::now(message)).is_some();
        self.shared.stats().replaced += u64::from(replaced);
        self.shared.filled.notify_one();
        Ok(())
    }

    /// Past the task, where nothing waits before it and the transport can: whether it went out.
    fn send_now(&self, message: &MavMessage) -> bool {
        let idle = self.queue.capacity() == self.queue.max_capacity();
        let slot = self.shared.latest();
        if !idle || slot.is_some() {
            return false;
        }
        let sent = self.shared.pen().send_now(message);
        drop(slot);
        let Some(bytes) = sent else { return false };
        let mut stats = self.shared.stats();
        stats.sent_frames += 1;
        stats.sent_bytes += bytes as u64;
        true
    }

    /// Empties the slot: a setpoint that was not sent yet will not be.
    pub fn clear_latest(&self) {
        let withdrawn = self.shared.latest().take().is_some();
        self.shared.stats().replaced += u64::from(withdrawn);
    }

    /// Gives up this writer and waits until the link's task is over, which it is when every other writer and the reader are
    /// gone. What was received until then is recorded and counted: this is what passed the link, and nothing comes after it.
    pub async fn close(self) -> LinkStats {
        let shared = self.shared.clone();
        drop(self);
        shared.ended.notified().await;
        shared.stats().clone()
    }

    /// Waits until all that was given before is sent, or dropped by the loss of the link.
    ///
    /// # Errors
    /// The link has ended.
    pub async fn flush(&self) -> Result<(), LinkError> {
        let (done, mut answer) = oneshot::channel();
        if !self.is_connected() {
            // what waited was dropped by the loss
            return if self.queue.is_closed() { Err(LinkError::Closed) } else { Ok(()) };
        }
        self.queue.send(Item::Barrier(done)).await.map_err(|_| LinkError::Closed)?;
        loop {
            match timeout(LOOK, &mut answer).await {
                Ok(answered) => return answered.map_err(|_| LinkError::Closed),
                Err(_) if !self.is_connected() => return Ok(()),
                Err(_) => {}
            }
        }
    }

    /// What passed the link so far.
    #[must_use]
    pub fn stats(&self) -> LinkStats {
        self.shared.stats().clone()
    }

    /// When the link's task last ran: some 10 ms ago at most, unless it stands still or has ended.
    #[must_use]
    pub fn ran(&self) -> Instant {
        self.shared.ran()
    }

    /// Whether there is somebody to send to. UDP cannot know whether anybody is there.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.shared.open.load(Ordering::Acquire)
    }

    fn check(&self) -> Result<(), LinkError> {
        if self.queue.is_closed() {
            return Err(LinkError::Closed);
        }
        if self.is_connected() {
            Ok(())
        } else {
            Err(LinkError::NotConnected { address: self.shared.name.clone() })
        }
    }

    fn queue(&self, item: Item) -> Result<(), LinkError> {
        self.check()?;
        self.queue.try_send(item).map_err(|error| match error {
            mpsc::error::TrySendError::Closed(_) => LinkError::Closed,
            mpsc::error::TrySendError::Full(_) => {
                LinkError::QueueFull { address: self.shared.name.clone(), queued: self.queue.max_capacity() }
            }
        })
    }
}
