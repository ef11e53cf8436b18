//! The log of events: one JSON object a line, written by a thread of its own so that a slow disk holds
//! nothing up.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::mpsc::{self, Sender};
use std::thread::{self, JoinHandle};

use crate::fly::outcome::Note;

/// The log while it is written.
#[derive(Debug)]
pub(super) struct Journal {
    notes: Sender<Note>,
    thread: JoinHandle<io::Result<()>>,
}

impl Journal {
    /// A new file.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let mut to = BufWriter::new(File::create(path)?);
        let (notes, from) = mpsc::channel::<Note>();
        let work = move || {
            for note in from {
                serde_json::to_writer(&mut to, &note)?;
                to.write_all(b"\n")?;
                to.flush()?;
            }
            Ok(())
        };
        Ok(Self { notes, thread: thread::Builder::new().name("events".into()).spawn(work)? })
    }

    /// Takes a note. One that the disk refuses shows in [`Journal::finish`].
    pub(super) fn write(&self, note: &Note) {
        let _ = self.notes.send(note.clone());
    }

    /// Waits until all of it is written.
    pub(super) fn finish(self) -> io::Result<()> {
        drop(self.notes);
        self.thread.join().unwrap_or_else(|_| Err(io::Error::other("the writer of events panicked")))
    }
}
