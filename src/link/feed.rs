//! A link without another end: the program itself gives what is received.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::sleep;

use super::clock::HostStamp;
use super::event::LinkEvent;
use super::incoming::WAITING;
use super::options::LinkOptions;
use super::reader::LinkReader;
use super::received::{Received, ReceivedFrame};
use super::shared::Shared;
use crate::wire::Frame;

/// How long to wait for a reader that is behind.
const BEHIND: Duration = Duration::from_millis(1);

/// The end of such a link at which frames and events are put in. When it is dropped, the reader hears that the link has
/// ended.
#[derive(Debug)]
pub struct LinkFeed {
    to_reader: mpsc::UnboundedSender<Received>,
    shared: Arc<Shared>,
}

impl LinkFeed {
    /// A link of this name, for messages. There is no writer.
    #[must_use]
    pub fn new(name: String) -> (Self, LinkReader) {
        let shared = Arc::new(Shared::new(name, None, &LinkOptions::default()));
        let (to_reader, from_feed) = mpsc::unbounded_channel();
        let reader = LinkReader::new(from_feed, shared.clone(), None);
        (Self { to_reader, shared }, reader)
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// Waits until the reader is no longer far behind.
    pub async fn ready(&self) {
        while self.shared.waiting.load(Ordering::Relaxed) >= WAITING {
            sleep(BEHIND).await;
        }
    }

    /// Gives a frame; `false` where the reader is gone.
    pub fn frame(&self, stamp: HostStamp, frame: Frame<'_>) -> bool {
        self.shared.stats().tally(&frame);
        self.give(Received::Frame(ReceivedFrame::new(stamp, frame)))
    }

    /// Gives an event; `false` where the reader is gone.
    pub fn event(&self, event: LinkEvent) -> bool {
        self.give(Received::Event(event))
    }

    fn give(&self, received: Received) -> bool {
        self.shared.waiting.fetch_add(1, Ordering::Relaxed);
        self.to_reader.send(received).is_ok()
    }
}
