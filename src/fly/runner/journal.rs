//! What a flight writes beside its recording: the log of events, one JSON object a line, and the vehicle's parameters.
//!
//! A thread of its own writes, so that a slow or full disk holds nothing up; what finds no room in its queue is left
//! out and counted. After a failure it goes on trying: a full disk may be made room on.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::timeout;

use crate::files::write_whole;
use crate::fly::outcome::Note;
use crate::text;

/// Notes that may wait for the disk: more than a flight usually has.
const WAITING: usize = 1024;
/// How long the end of a flight waits for the disk.
const PATIENCE: Duration = Duration::from_secs(3);

/// The log while it is written.
#[derive(Debug)]
pub(super) struct Journal {
    to: SyncSender<Entry>,
    state: Arc<Mutex<State>>,
    over: oneshot::Receiver<()>,
}

#[derive(Debug)]
enum Entry {
    Note(Note),
    /// a file of its own
    File(PathBuf, String),
}

/// What went wrong so far.
#[derive(Debug, Default)]
struct State {
    /// notes that are not in the log
    missing: u64,
    /// what the system last said
    failure: Option<String>,
    /// of this much trouble somebody was told
    told: bool,
}

impl State {
    fn trouble(&self) -> Option<String> {
        let why = self.failure.as_deref().unwrap_or("the disk is too slow");
        match self.missing {
            0 => self.failure.as_ref().map(|failure| format!("cannot write: {failure}")),
            missing => Some(format!("{missing} lines of events are missing: {why}")),
        }
    }
}

impl Journal {
    /// Goes on at the end of a file, or begins a new one.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let file: File = OpenOptions::new().create(true).append(true).open(path)?;
        Self::to_store(file)
    }

    fn to_store(store: impl Write + Send + 'static) -> io::Result<Self> {
        let (to, from) = mpsc::sync_channel(WAITING);
        let state = Arc::new(Mutex::new(State::default()));
        let (done, over) = oneshot::channel();
        let shared = state.clone();
        thread::Builder::new().name("events".into()).spawn(move || {
            work(store, &from, &shared);
            // whoever asked may have given up
            let _ = done.send(());
        })?;
        Ok(Self { to, state, over })
    }

    /// Takes a note; never waits.
    pub(super) fn write(&self, note: &Note) {
        if self.to.try_send(Entry::Note(note.clone())).is_err() {
            locked(&self.state).missing += 1;
        }
    }

    /// Writes a file; does not wait for it.
    pub(super) fn keep(&self, path: PathBuf, text: String) {
        if let Err(error) = self.to.try_send(Entry::File(path, text)) {
            let (mpsc::TrySendError::Full(entry) | mpsc::TrySendError::Disconnected(entry)) = error;
            if let Entry::File(path, _) = entry {
                locked(&self.state).failure = Some(format!("{}: the disk is too slow", text::path(&path)));
            }
        }
    }

    /// What goes wrong, told once: by a channel that works.
    pub(super) fn news(&self) -> Option<String> {
        let mut state = locked(&self.state);
        let trouble = state.trouble().filter(|_| !state.told)?;
        state.told = true;
        Some(trouble)
    }

    /// Waits until all of it is written, or the disk takes nothing more; what is missing.
    pub(super) async fn finish(self) -> Option<String> {
        drop(self.to);
        let ended = timeout(PATIENCE, self.over).await;
        let trouble = locked(&self.state).trouble();
        match ended {
            Ok(Ok(())) => trouble,
            Ok(Err(_)) => Some("the writer of events panicked".to_owned()),
            Err(_) => {
                let told = format!(
                    "the last events are missing: the disk took nothing for {} s",
                    PATIENCE.as_secs()
                );
                Some(trouble.map_or(told.clone(), |trouble| format!("{told}; {trouble}")))
            }
        }
    }
}

/// A state is whole at every moment.
fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

fn work(mut store: impl Write, from: &Receiver<Entry>, state: &Mutex<State>) {
    // a line that was torn ends before the next begins
    let mut torn = false;
    for entry in from {
        let failure = match entry {
            Entry::Note(note) => {
                let written = text::json_line(&note).map_err(io::Error::from).and_then(|line| {
                    let begin = if torn { "\n" } else { "" };
                    let whole = store.write_all(format!("{begin}{line}\n").as_bytes());
                    torn = whole.is_err();
                    whole
                });
                written.err().map(|error| (1, error.to_string()))
            }
            Entry::File(path, text) => {
                let written = write_whole(&path, text.as_bytes());
                written.err().map(|error| (0, format!("{}: {error}", text::path(&path))))
            }
        };
        // both at once: whoever asks meanwhile is not told a line without its reason
        if let Some((lines, failure)) = failure {
            let mut state = locked(state);
            state.missing += lines;
            state.failure = Some(failure);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fly::outcome::Level;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn note(text: &str) -> Note {
        Note::new(Duration::ZERO, Level::Information, "test", text)
    }

    /// A disk that takes so many bytes; with a gate it waits for a ticket each time.
    struct Disk {
        held: Arc<Mutex<Vec<u8>>>,
        room: Arc<AtomicUsize>,
        gate: Option<Receiver<()>>,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if let Some(gate) = &self.gate {
                let _ = gate.recv();
            }
            let count = bytes.len().min(self.room.load(Ordering::SeqCst));
            if count == 0 {
                return Err(io::Error::new(io::ErrorKind::StorageFull, "the disk is full"));
            }
            self.room.fetch_sub(count, Ordering::SeqCst);
            self.held.lock().unwrap().extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[tokio::test]
    async fn a_full_disk_costs_lines_and_is_told_once_and_at_the_end() {
        let (held, room) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicUsize::new(100)));
        let disk = Disk { held: held.clone(), room: room.clone(), gate: None };
        let journal = Journal::to_store(disk).unwrap();
        for number in 0..5 {
            journal.write(&note(&format!("before {number}")));
        }
        let told = loop {
            match journal.news() {
                Some(told) => break told,
                None => tokio::task::yield_now().await,
            }
        };
        assert!(told.contains("missing: the disk is full"), "{told}");
        assert_eq!(journal.news(), None);
        // the thread may still be at the lines before
        while locked(&journal.state).missing < 4 {
            tokio::task::yield_now().await;
        }
        room.store(10_000, Ordering::SeqCst);
        journal.write(&note("after"));
        let end = journal.finish().await.unwrap();
        assert!(end.starts_with("4 lines of events are missing"), "{end}");
        let text = String::from_utf8(held.lock().unwrap().clone()).unwrap();
        let whole: Vec<&str> =
            text.lines().filter(|line| serde_json::from_str::<serde_json::Value>(line).is_ok()).collect();
        assert!(whole.len() == 2 && whole[1].contains("after"), "{text}");
    }

    #[tokio::test(start_paused = true)]
    async fn a_disk_that_stands_still_is_not_waited_for() {
        let (ticket, gate) = mpsc::channel();
        let room = Arc::new(AtomicUsize::new(usize::MAX));
        let held = Arc::new(Mutex::new(Vec::new()));
        let journal = Journal::to_store(Disk { held: held.clone(), room, gate: Some(gate) }).unwrap();
        for number in 0..2000 {
            journal.write(&note(&format!("{number}")));
        }
        let told = journal.news().unwrap();
        assert!(told.contains("missing: the disk is too slow"), "{told}");
        let end = journal.finish().await.unwrap();
        assert!(end.contains("the disk took nothing for 3 s"), "{end}");
        drop(ticket);
    }
}
