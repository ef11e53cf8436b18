//! What a recorder and its thread share.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::backlog::{Backlog, Taken};
use super::store::Store;

/// What a recorder and its thread share.
#[derive(Debug, Default)]
pub(super) struct State {
    /// in the queue, or in the thread's hands
    pub waiting_bytes: AtomicUsize,
    /// frames that came to be recorded
    pub given: AtomicU64,
    pub frames: AtomicU64,
    pub bytes: AtomicU64,
    pub dropped: AtomicU64,
    pub doubtful: AtomicU64,
    pub redacted: AtomicU64,
    pub failing: AtomicBool,
    /// ended: what comes now is not of the recording
    pub over: AtomicBool,
    /// frames were dropped, and the disk has not caught up yet
    pub behind: AtomicBool,
    pub failure: Mutex<Option<String>>,
}

impl State {
    /// Takes over what the store took.
    pub fn count<S: Store>(&self, backlog: &mut Backlog<S>) {
        let Taken { records, bytes } = backlog.take_taken();
        self.frames.fetch_add(records, Ordering::Relaxed);
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
        self.doubtful.store(backlog.doubtful(), Ordering::Relaxed);
        self.waiting_bytes.fetch_sub(usize::try_from(bytes).unwrap_or(usize::MAX), Ordering::Relaxed);
    }

    pub fn note_failure(&self, error: Option<&io::Error>) {
        self.failing.store(error.is_some(), Ordering::Relaxed);
        let text = error.map(ToString::to_string);
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = text;
    }
}
