//! What the halves of a link and its task share.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::{Notify, watch};

use super::given::Given;
use super::options::LinkOptions;
use super::pen::Pen;
use super::stats::LinkStats;

/// What the halves of a link and its task share.
#[derive(Debug)]
pub(super) struct Shared {
    /// the address, for messages
    pub name: String,
    /// where a socket listens or sends from
    pub local: Option<SocketAddr>,
    /// frames given now are sent
    pub open: AtomicBool,
    /// frames and events that wait for the reader
    pub waiting: AtomicUsize,
    /// the slot of which only the latest message matters was filled
    pub filled: Notify,
    /// all writers are gone and all that they gave is sent
    pub drained: Notify,
    /// the task is over, and all that it received is recorded
    pub ended: Notify,
    /// when this was made, and how many ms later the link's task last ran
    made: Instant,
    ran_ms: AtomicU64,
    latest: Mutex<Option<Given>>,
    pen: Mutex<Pen>,
    stats: Mutex<LinkStats>,
}

impl Shared {
    pub fn new(name: String, local: Option<SocketAddr>, options: &LinkOptions) -> Self {
        Self {
            name,
            local,
            open: AtomicBool::default(),
            waiting: AtomicUsize::default(),
            filled: Notify::default(),
            drained: Notify::default(),
            ended: Notify::default(),
            made: Instant::now(),
            ran_ms: AtomicU64::default(),
            latest: Mutex::default(),
            pen: Mutex::new(Pen::new(options)),
            stats: Mutex::default(),
        }
    }

    /// The link's task runs.
    pub fn runs(&self) {
        let ms = u64::try_from(self.made.elapsed().as_millis()).unwrap_or(u64::MAX);
        self.ran_ms.store(ms, Ordering::Release);
    }

    /// When the link's task last ran.
    pub fn ran(&self) -> Instant {
        self.made + Duration::from_millis(self.ran_ms.load(Ordering::Acquire))
    }

    /// No code holding these locks panics; a poisoned one would still hold whole values.
    pub fn stats(&self) -> MutexGuard<'_, LinkStats> {
        self.stats.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Taken after [`Self::latest`] where both are.
    pub fn pen(&self) -> MutexGuard<'_, Pen> {
        self.pen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn latest(&self) -> MutexGuard<'_, Option<Given>> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Held by the halves of a link: when the last is gone the task ends.
pub(super) type Alive = Arc<watch::Sender<()>>;
