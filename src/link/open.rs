//! Opens links.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use tokio::sync::{mpsc, watch};

use super::address::Address;
use super::error::LinkError;
use super::halt::{Halt, Stop, panic_for_test};
use super::incoming::Incoming;
use super::options::LinkOptions;
use super::outgoing::Outgoing;
use super::reader::LinkReader;
use super::shared::Shared;
use super::transport::{self, Transport};
use super::writer::LinkWriter;

/// Frames that may wait to be sent.
pub(super) const QUEUE: usize = 4096;
/// How long a link that both halves have left continues sending what they gave.
const LINGER: Duration = Duration::from_secs(1);

/// So often the link's task says that it runs.
const RUNS: Duration = Duration::from_millis(10);

/// Opens links.
#[derive(Debug)]
pub struct Link;

impl Link {
    /// Opens a link and starts its task on the current tokio runtime. The task ends when both halves are
    /// dropped; what was given to the writer before is still sent.
    ///
    /// `udpin`, `tcpin` and `pty` links, and patient `tcpout` links, are open before anybody is at the other end:
    /// wait for [`LinkEvent::Connected`](super::LinkEvent::Connected).
    ///
    /// # Errors
    /// The address cannot be resolved, bound, connected to or opened now. Later losses are events.
    pub async fn open(address: &Address, options: LinkOptions) -> Result<Ends, LinkError> {
        let transport = transport::open(address, (options.peer_timeout, options.patient)).await?;
        tracing::info!(%address, connected = transport.is_connected(), "link opened");
        Ok(start(address.to_string(), transport, &options))
    }

    /// Two links in memory that talk to each other: for a vehicle and a ground station in one process, and
    /// for tests with a paused clock.
    #[must_use]
    pub fn pair(first: LinkOptions, second: LinkOptions) -> (Ends, Ends) {
        let (one, two) = tokio::io::duplex(1 << 16);
        let start = |stream, options| start("memory".into(), Transport::Memory(Some(stream)), &options);
        (start(one, first), start(two, second))
    }
}

/// Both halves of a link.
pub type Ends = (LinkReader, LinkWriter);

fn start(name: String, transport: Transport, options: &LinkOptions) -> Ends {
    let shared = Arc::new(Shared::new(name, transport.local(), options));
    shared.open.store(transport.is_connected(), Ordering::Release);
    let (to_reader, from_task) = mpsc::unbounded_channel();
    let (to_task, queue) = mpsc::channel(QUEUE);
    let (alive, gone) = watch::channel(());
    let alive = Arc::new(alive);
    let incoming = Incoming::new(to_reader, shared.clone(), options);
    let outgoing = Outgoing::new(queue, shared.clone());
    let halt = options.halt.clone();
    tokio::spawn(drive(transport, (incoming, outgoing), gone, shared.clone(), halt));
    (LinkReader::new(from_task, shared.clone(), Some(alive.clone())), LinkWriter::new(to_task, shared, alive))
}

async fn drive(
    mut transport: Transport,
    (mut incoming, mut outgoing): (Incoming, Outgoing),
    mut gone: watch::Receiver<()>,
    shared: Arc<Shared>,
    halt: Halt,
) {
    let left = async {
        // nothing is ever sent on it: it only ends
        let _ = gone.changed().await;
        let _ = tokio::time::timeout(LINGER, shared.drained.notified()).await;
    };
    tokio::select! {
        () = transport.serve(&mut incoming, &mut outgoing) => {}
        () = left => {}
        () = run(&shared, &halt) => {}
    }
    // what waits for its continuation is decided
    incoming.silence(incoming.now());
    shared.ended.notify_one();
}

/// Says every now and then that the task runs, and in a test stops it.
async fn run(shared: &Shared, halt: &Halt) {
    loop {
        match halt.stopped() {
            Some(Stop::Stands) => {
                std::thread::sleep(RUNS);
                continue;
            }
            Some(Stop::Panics) => panic_for_test("a test stops the link"),
            Some(Stop::Ends) => return,
            None => {}
        }
        shared.runs();
        halt.runs();
        tokio::time::sleep(RUNS).await;
    }
}
