//! The half of a link that hears.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use tokio::sync::mpsc;

use super::error::LinkError;
use super::received::Received;
use super::shared::{Alive, Shared};
use super::stats::LinkStats;

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
        Ok(self.take(received))
    }

    /// Emits the link's events. The link's own task emits none, because it carries setpoints and a subscriber may block.
    fn take(&self, received: Received) -> Received {
        self.shared.waiting.fetch_sub(1, Ordering::Relaxed);
        if let Received::Event(event) = &received {
            event.emit();
        }
        received
    }

    /// What is there already, `None` where nothing waits.
    ///
    /// # Errors
    /// The link has ended.
    pub fn try_receive(&mut self) -> Result<Option<Received>, LinkError> {
        match self.from.try_recv() {
            Ok(received) => Ok(Some(self.take(received))),
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
