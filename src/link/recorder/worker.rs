//! The thread that writes a recording.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use tokio::sync::oneshot;

use super::State;
use super::watch::ModeWatch;
use crate::log::{Frame, STAMP_BYTES, TlogWriter};

/// A kill costs no more than what came within this.
const FLUSH: Duration = Duration::from_secs(1);
const BUFFER: usize = 1 << 16;

/// What a recording is written to.
pub trait Store: Write + Send {
    /// Brings what was written to where a power loss does not reach it.
    ///
    /// # Errors
    /// What the system says.
    fn sync(&mut self) -> io::Result<()>;
}

impl Store for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }
}

/// Something for the thread to do.
#[derive(Debug)]
pub(super) enum Order {
    Frame {
        stamp_us: u64,
        bytes: Box<[u8]>,
    },
    Flush(Option<oneshot::Sender<()>>),
    /// the last one
    End(oneshot::Sender<()>),
}

/// Flushing it also syncs. Its buffer hands on whole records only.
struct Synced<S: Store>(BufWriter<S>);

impl<S: Store> Write for Synced<S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()?;
        self.0.get_mut().sync()
    }
}

/// Writes until all recorders are gone, or the recording is ended. After a failure it goes on trying: a full disk may be made room on.
pub(super) fn work(store: impl Store, orders: &Receiver<Order>, state: &State) {
    let mut log = TlogWriter::new(Synced(BufWriter::with_capacity(BUFFER, store)));
    let mut watch = ModeWatch::default();
    let mut due = Instant::now() + FLUSH;
    loop {
        let order = orders.recv_timeout(due.saturating_duration_since(Instant::now()));
        let mut flush = Instant::now() >= due;
        let mut waiting = None;
        match order {
            Ok(Order::Frame { stamp_us, bytes }) => {
                if let Some(frame) = Frame::at_start(&bytes) {
                    write(&mut log, stamp_us, frame, state);
                    flush |= watch.changed(&frame);
                }
                state.waiting_bytes.fetch_sub(bytes.len() + STAMP_BYTES, Ordering::Relaxed);
            }
            Ok(Order::Flush(done)) => {
                flush = true;
                waiting = done;
            }
            Ok(Order::End(done)) => {
                state.over.store(true, Ordering::Release);
                state.note_failure(log.flush().err().as_ref());
                // whoever asked may have given up
                let _ = done.send(());
                return;
            }
            Err(RecvTimeoutError::Timeout) => flush = true,
            Err(RecvTimeoutError::Disconnected) => {
                state.note_failure(log.flush().err().as_ref());
                return;
            }
        }
        if flush {
            state.note_failure(log.flush().err().as_ref());
            due = Instant::now() + FLUSH;
        }
        if let Some(done) = waiting {
            // whoever asked may have given up
            let _ = done.send(());
        }
    }
}

fn write<S: Store>(log: &mut TlogWriter<Synced<S>>, stamp_us: u64, frame: Frame<'_>, state: &State) {
    match log.write(stamp_us, frame) {
        Ok(_) => {
            state.frames.fetch_add(1, Ordering::Relaxed);
            state.bytes.fetch_add((frame.bytes().len() + STAMP_BYTES) as u64, Ordering::Relaxed);
        }
        Err(error) => {
            state.dropped.fetch_add(1, Ordering::Relaxed);
            state.note_failure(Some(&error));
        }
    }
}
