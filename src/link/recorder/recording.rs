//! Records the frames of one or more links.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, mpsc};
use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::timeout;

use super::error::RecordError;
use super::state::State;
use super::status::RecorderStatus;
use super::store::Store;
use super::worker::{Order, work};
use crate::link::clock::HostStamp;
use crate::wire::message_id::SETUP_SIGNING;
use crate::wire::{Frame, STAMP_BYTES};

/// Bytes that may wait for a slow disk: 20 minutes of a lively link.
const WAITING_BYTES: usize = 64 << 20;
/// A disk that takes nothing for so long has failed.
const PATIENCE: Duration = Duration::from_secs(3);

/// The recording of one or more links. Clones write to the same file, which is complete when the last of
/// them is gone, or after [`finish`](Self::finish).
#[derive(Debug, Clone)]
pub struct Recorder {
    orders: mpsc::Sender<Order>,
    state: Arc<State>,
    waiting_max: usize,
}

impl Recorder {
    /// Records to a new file; one that is there already is replaced only where `replace` says so.
    ///
    /// # Errors
    /// The file exists or cannot be made, or the system gives no thread.
    pub fn create(path: &Path, replace: bool) -> Result<Self, RecordError> {
        let mut options = OpenOptions::new();
        options.write(true);
        if replace {
            options.create(true).truncate(true);
        } else {
            options.create_new(true);
        }
        let file: File = options.open(path).map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => RecordError::Exists { path: path.into() },
            _ => RecordError::Create { path: path.into(), source },
        })?;
        // nobody takes it away while it is written; a file system without locks does without
        let _ = file.try_lock();
        Self::to_store(file, WAITING_BYTES)
    }

    /// Records to any store. At most `waiting_max` bytes wait for it.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn to_store(store: impl Store + 'static, waiting_max: usize) -> Result<Self, RecordError> {
        let (orders, to_do) = mpsc::channel();
        let state = Arc::new(State::default());
        let shared = state.clone();
        std::thread::Builder::new()
            .name("recorder".into())
            .spawn(move || work(store, &to_do, &shared))
            .map_err(RecordError::Thread)?;
        Ok(Self { orders, state, waiting_max })
    }

    /// Records a frame; never waits. Whether the recording is whole: a frame may have been dropped.
    pub(in crate::link) fn record(&self, stamp: HostStamp, frame: &Frame<'_>) -> bool {
        if self.is_over() {
            return true;
        }
        // it carries the signing key
        if frame.header().message_id == SETUP_SIGNING {
            self.state.redacted.fetch_add(1, Ordering::Relaxed);
            return true;
        }
        self.state.given.fetch_add(1, Ordering::Relaxed);
        let bytes = frame.bytes().len() + STAMP_BYTES;
        let waiting = self.state.waiting_bytes.fetch_add(bytes, Ordering::Relaxed) + bytes;
        let order = Order::Frame { stamp_us: stamp.utc_us, bytes: frame.bytes().into() };
        if waiting > self.waiting_max || self.orders.send(order).is_err() {
            self.state.waiting_bytes.fetch_sub(bytes, Ordering::Relaxed);
            if self.is_over() {
                self.state.given.fetch_sub(1, Ordering::Relaxed);
                return true;
            }
            self.state.dropped.fetch_add(1, Ordering::Relaxed);
            self.state.behind.store(true, Ordering::Relaxed);
            return false;
        }
        // it has caught up where half of the room is free: one frame that fits again is not worth telling
        if waiting <= self.waiting_max / 2 {
            self.state.behind.store(false, Ordering::Relaxed);
        }
        !self.state.failing.load(Ordering::Relaxed) && !self.state.behind.load(Ordering::Relaxed)
    }

    /// Asks for everything recorded so far to be brought onto the disk now; does not wait.
    pub fn flush(&self) {
        // a recorder that has ended has nothing to flush
        let _ = self.orders.send(Order::Flush(None));
    }

    /// Waits until everything recorded so far is on the disk, and says what became of it.
    ///
    /// # Errors
    /// The recorder's thread is gone.
    pub async fn finish(&self) -> Result<RecorderStatus, RecordError> {
        let (done, answer) = oneshot::channel();
        self.orders.send(Order::Flush(Some(done))).map_err(|_| RecordError::Ended)?;
        answer.await.map_err(|_| RecordError::Ended)?;
        Ok(self.status())
    }

    /// Ends the recording: brings it onto the disk and says what became of it. What comes later is neither written nor
    /// counted. A disk that takes nothing for 3 s is not waited for any longer: what it did not take counts as lost.
    ///
    /// # Errors
    /// It has ended already.
    pub async fn end(&self) -> Result<RecorderStatus, RecordError> {
        let (done, mut answer) = oneshot::channel();
        self.orders.send(Order::End(done)).map_err(|_| RecordError::Ended)?;
        loop {
            let before = self.status().frames;
            match timeout(PATIENCE, &mut answer).await {
                Ok(answered) => {
                    answered.map_err(|_| RecordError::Ended)?;
                    return Ok(self.status());
                }
                Err(_) if self.status().frames > before => {}
                Err(_) => return Ok(self.given_up()),
            }
        }
    }

    /// What became of the frames where the disk takes nothing more.
    fn given_up(&self) -> RecorderStatus {
        self.state.over.store(true, Ordering::Release);
        let status = self.status();
        let missing = self.state.given.load(Ordering::Relaxed).saturating_sub(status.frames + status.dropped);
        let told = format!("the disk accepted nothing for {} s", PATIENCE.as_secs());
        RecorderStatus {
            dropped: status.dropped + missing,
            failure: Some(status.failure.map_or(told.clone(), |failure| format!("{told}; {failure}"))),
            ..status
        }
    }

    fn is_over(&self) -> bool {
        self.state.over.load(Ordering::Acquire)
    }

    /// What became of the frames so far.
    #[must_use]
    pub fn status(&self) -> RecorderStatus {
        let count = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        RecorderStatus {
            frames: count(&self.state.frames),
            bytes: count(&self.state.bytes),
            dropped: count(&self.state.dropped),
            doubtful: count(&self.state.doubtful),
            redacted: count(&self.state.redacted),
            failure: self.state.failure.lock().unwrap_or_else(PoisonError::into_inner).clone(),
        }
    }
}
