//! A link whose bytes somebody else carries: for a simulated network on a simulated clock.

use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::task::{Context, Poll, Waker};

use tokio::sync::{mpsc, watch};

use super::clock::HostStamp;
use super::incoming::Incoming;
use super::open::{Ends, Link, QUEUE};
use super::options::LinkOptions;
use super::outgoing::Outgoing;
use super::pen::Direct;
use super::reader::LinkReader;
use super::shared::Shared;
use super::writer::LinkWriter;

/// The task of a link, without a transport and without a runtime: it works when it is asked to.
#[derive(Debug)]
pub struct Carrier {
    incoming: Incoming,
    outgoing: Outgoing,
    /// what went past the task, as over UDP
    direct: Option<mpsc::UnboundedReceiver<Box<[u8]>>>,
    shared: Arc<Shared>,
}

impl Link {
    /// A link whose bytes the [`Carrier`] takes and gives; it is connected at once. With `datagrams` setpoints go past the
    /// task, as they do over UDP.
    #[must_use]
    pub fn carried(options: &LinkOptions, datagrams: bool) -> (Carrier, Ends) {
        let shared = Arc::new(Shared::new("memory".into(), None, options));
        let (to_reader, from_task) = mpsc::unbounded_channel();
        let (to_task, queue) = mpsc::channel(QUEUE);
        let alive = Arc::new(watch::channel(()).0);
        let direct = datagrams.then(|| {
            let (give, take) = mpsc::unbounded_channel();
            shared.pen().direct = Some(Direct::Carried(give));
            take
        });
        let mut incoming = Incoming::new(to_reader, shared.clone(), options);
        incoming.connected("memory".into());
        let outgoing = Outgoing::new(queue, shared.clone());
        let reader = LinkReader::new(from_task, shared.clone(), Some(alive.clone()));
        let writer = LinkWriter::new(to_task, shared.clone(), alive);
        (Carrier { incoming, outgoing, direct, shared }, (reader, writer))
    }
}

impl Carrier {
    /// A datagram arrived. Frames do not continue in the next.
    pub fn datagram(&mut self, bytes: &[u8], stamp: HostStamp) {
        self.incoming.datagram(bytes, stamp);
    }

    /// A piece of a stream arrived; frames may be cut anywhere.
    pub fn bytes(&mut self, bytes: &[u8], stamp: HostStamp) {
        self.incoming.bytes(bytes, stamp);
    }

    /// Frames and events that wait for the reader.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.shared.waiting.load(Ordering::Relaxed)
    }

    /// What went past the task since it was last asked, in order.
    pub fn went_past(&mut self) -> Option<Box<[u8]>> {
        self.direct.as_mut()?.try_recv().ok()
    }

    /// The frame that the task sends next; it counts as sent, and is recorded.
    pub fn next(&mut self, stamp: HostStamp) -> Option<Box<[u8]>> {
        let frame = {
            let next = pin!(self.outgoing.next());
            match next.poll(&mut Context::from_waker(Waker::noop())) {
                Poll::Ready(frame) => frame,
                Poll::Pending => return None,
            }
        };
        self.outgoing.sent(&frame, stamp);
        Some(frame)
    }

    /// The link ends: what waits for its continuation is decided.
    pub fn end(&mut self, stamp: HostStamp) {
        self.incoming.silence(stamp);
    }

    /// The other end is lost: what waits to be sent is forgotten.
    pub fn lost(&mut self, why: &str) {
        self.incoming.lost(why.to_owned());
        self.outgoing.discard();
    }

    /// The other end is there again.
    pub fn restored(&mut self) {
        self.incoming.connected("memory".into());
        self.outgoing.connected();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::{HostClock, Received};
    use crate::wire::Frame;
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage};

    #[test]
    fn what_one_carrier_gives_another_takes() {
        let options = LinkOptions::default();
        let stamp = HostClock::start().now();
        for datagrams in [true, false] {
            let (mut here, (_reader, writer)) = Link::carried(&options, datagrams);
            let (mut there, (mut reader, _writer)) = Link::carried(&options, datagrams);
            let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
            assert!(here.next(stamp).is_none());
            writer.send_message(&heartbeat).unwrap();
            let queued = here.next(stamp).unwrap();
            writer.send_latest(&heartbeat).unwrap();
            let latest = if datagrams { here.went_past() } else { here.next(stamp) }.unwrap();
            for (sequence, bytes) in [queued, latest].into_iter().enumerate() {
                assert_eq!(usize::from(Frame::at_start(&bytes).unwrap().header().sequence), sequence);
                there.datagram(&bytes, stamp);
            }
            assert!(matches!(reader.try_receive(), Ok(Some(Received::Event(_)))), "connected");
            for _ in 0..2 {
                assert!(matches!(reader.try_receive(), Ok(Some(Received::Frame(_)))));
            }
            assert!(matches!(reader.try_receive(), Ok(None)));
        }
    }

    #[tokio::test(start_paused = true)]
    async fn what_waited_for_a_task_that_stood_still_is_not_sent() {
        let clock = HostClock::start();
        let (mut carrier, (_reader, writer)) = Link::carried(&LinkOptions::default(), false);
        let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        for (waited_ms, sent) in [(90, 2), (110, 0)] {
            writer.send_message(&heartbeat).unwrap();
            writer.send_latest(&heartbeat).unwrap();
            tokio::time::advance(std::time::Duration::from_millis(waited_ms)).await;
            let frames = std::iter::from_fn(|| carrier.next(clock.now())).count();
            assert_eq!(frames, sent, "after {waited_ms} ms");
        }
        assert_eq!(writer.stats().unsent, 2);
    }

    #[test]
    fn what_waited_when_the_other_end_was_lost_is_not_sent() {
        let stamp = HostClock::start().now();
        let (mut carrier, (_reader, writer)) = Link::carried(&LinkOptions::default(), false);
        let heartbeat = MavMessage::HEARTBEAT(HEARTBEAT_DATA::default());
        writer.send_message(&heartbeat).unwrap();
        carrier.lost("cut");
        assert!(writer.send_message(&heartbeat).is_err());
        carrier.restored();
        assert!(carrier.next(stamp).is_none());
        writer.send_message(&heartbeat).unwrap();
        assert!(carrier.next(stamp).is_some());
    }
}
