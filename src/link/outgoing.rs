//! From messages and frames to the bytes that are sent next.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::Arc;

use tokio::net::UdpSocket;
use tokio::sync::{mpsc, oneshot};

use super::clock::HostStamp;
use super::given::Given;
use super::pen::Direct;
use super::shared::Shared;

/// Something for the ordered queue.
#[derive(Debug)]
pub(super) enum Item {
    /// to be sent as it is
    Frame(Box<[u8]>),
    /// to be given its sequence number when it is sent
    Message(Given),
    /// to be answered when all before is sent
    Barrier(oneshot::Sender<()>),
}

/// From messages and frames to the bytes that are sent next.
#[derive(Debug)]
pub(super) struct Outgoing {
    queue: mpsc::Receiver<Item>,
    shared: Arc<Shared>,
    /// the last frame came from the slot: the queue has its turn
    queue_first: bool,
    /// the other end was lost and is not back
    lost: bool,
    barriers: VecDeque<oneshot::Sender<()>>,
}

impl Outgoing {
    pub fn new(queue: mpsc::Receiver<Item>, shared: Arc<Shared>) -> Self {
        Self { queue, shared, queue_first: false, lost: false, barriers: VecDeque::new() }
    }

    /// The next frame to send; the one before is sent when this is called. Cancel-safe: nothing is taken
    /// before it returns.
    pub async fn next(&mut self) -> Box<[u8]> {
        loop {
            let item = self.pick().await;
            let mut pen = self.shared.pen();
            pen.in_flight = true;
            match item {
                Item::Frame(bytes) => return bytes,
                Item::Message(given) if given.is_old() => {
                    pen.in_flight = false;
                    drop(pen);
                    self.shared.stats().unsent += 1;
                }
                Item::Message(given) => return pen.write(&given.message),
                Item::Barrier(done) => {
                    pen.in_flight = false;
                    self.barriers.push_back(done);
                }
            }
        }
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
            if let Some(given) = self.taken_from_slot() {
                self.queue_first = true;
                return Item::Message(given);
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

    /// In flight before the slot is open to others, so that nobody sends a younger one before it.
    fn taken_from_slot(&self) -> Option<Given> {
        let mut slot = self.shared.latest();
        let given = slot.take()?;
        self.shared.pen().in_flight = true;
        Some(given)
    }

    /// Slot and queue are empty and the last frame is sent.
    fn answer_barriers(&mut self) {
        for done in self.barriers.drain(..) {
            let _ = done.send(());
        }
    }

    /// The present moment: to be taken when a frame is handed to the system.
    pub fn now(&self) -> HostStamp {
        self.shared.pen().now()
    }

    /// A frame went out.
    pub fn sent(&mut self, frame: &[u8], stamp: HostStamp) {
        let mut pen = self.shared.pen();
        pen.in_flight = false;
        pen.record(stamp, frame);
        drop(pen);
        let mut stats = self.shared.stats();
        stats.sent_frames += 1;
        stats.sent_bytes += frame.len() as u64;
    }

    /// A frame did not go out.
    pub fn failed(&mut self) {
        self.shared.pen().in_flight = false;
        self.shared.stats().unsent += 1;
    }

    /// Latest messages may go to this socket past the task, until the other end is lost.
    pub fn open_direct(&mut self, socket: &Arc<UdpSocket>, to: Option<SocketAddr>) {
        self.shared.pen().direct = Some(Direct::Socket(socket.clone(), to));
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
        let mut pen = self.shared.pen();
        pen.direct = None;
        unsent += u64::from(std::mem::take(&mut pen.in_flight));
        drop(pen);
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
