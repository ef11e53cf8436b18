//! The way of a flight's notes, and of its other files, to the thread that writes them.

use std::path::PathBuf;
use std::sync::mpsc::{self, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::fly::outcome::Note;
use crate::text;

/// What waits for the disk.
#[derive(Debug)]
pub(super) enum Entry {
    /// a line of the log of events
    Note(Note),
    /// a file of its own
    File(PathBuf, String),
}

/// Gives entries to the thread that writes them, and never waits for it. Clones give to the same thread, which ends with
/// the last of them.
#[derive(Debug, Clone)]
pub(super) struct Feed {
    to: SyncSender<Entry>,
    state: Arc<Mutex<State>>,
}

impl Feed {
    /// To the thread at the other end of `to`, which shares `state`.
    pub(super) fn new(to: SyncSender<Entry>, state: Arc<Mutex<State>>) -> Self {
        Self { to, state }
    }

    /// Takes a note. One that finds no room is left out, and counted.
    pub(super) fn write(&self, note: Note) {
        if self.to.try_send(Entry::Note(note)).is_err() {
            locked(&self.state).missing += 1;
        }
    }

    /// Takes a file to be written.
    pub(super) fn keep(&self, path: PathBuf, text: String) {
        if let Err(error) = self.to.try_send(Entry::File(path, text)) {
            let (mpsc::TrySendError::Full(entry) | mpsc::TrySendError::Disconnected(entry)) = error;
            if let Entry::File(path, _) = entry {
                locked(&self.state).failure = Some(format!("{}: the disk is too slow", text::path(&path)));
            }
        }
    }
}

/// What went wrong so far.
#[derive(Debug, Default)]
pub(super) struct State {
    /// notes that are not in the log
    pub(super) missing: u64,
    /// what the system last said
    pub(super) failure: Option<String>,
    /// of this much trouble somebody was told
    pub(super) is_reported: bool,
}

impl State {
    /// In words; `None` where all is well.
    pub(super) fn trouble(&self) -> Option<String> {
        let why = self.failure.as_deref().unwrap_or("the disk is too slow");
        match self.missing {
            0 => self.failure.as_ref().map(|failure| format!("cannot write: {failure}")),
            missing => Some(format!("{missing} lines of events are missing: {why}")),
        }
    }
}

/// A state is whole at every moment.
pub(super) fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
