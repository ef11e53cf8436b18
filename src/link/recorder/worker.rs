//! The thread that writes a recording.

use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use tokio::sync::oneshot;

use super::backlog::Backlog;
use super::state::State;
use super::store::Store;
use super::watch::ModeWatch;
use crate::wire::{Frame, TlogWriter};

/// A kill costs no more than what came within this.
const FLUSH: Duration = Duration::from_secs(1);

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

/// Writes until all recorders are gone, or the recording is ended. After a failure it continues trying: a full disk may
/// be made room on.
pub(super) fn work(store: impl Store, orders: &Receiver<Order>, state: &State) {
    let mut log = TlogWriter::new(Backlog::new(store));
    let mut watch = ModeWatch::default();
    let mut due = Instant::now() + FLUSH;
    loop {
        let order = orders.recv_timeout(due.saturating_duration_since(Instant::now()));
        let mut flush = Instant::now() >= due;
        let mut waiting = None;
        match order {
            Ok(Order::Frame { stamp_us, bytes }) => {
                if let Some(frame) = Frame::at_start(&bytes) {
                    flush |= watch.changed(&frame);
                    // it only joins those that wait
                    let _ = log.write(stamp_us, frame);
                }
                let drained = log.get_mut().drain_if_much();
                if let Err(error) = &drained {
                    state.note_failure(Some(error));
                }
                state.count(log.get_mut());
            }
            Ok(Order::Flush(done)) => {
                flush = true;
                waiting = done;
            }
            Ok(Order::End(done)) => {
                state.over.store(true, Ordering::Release);
                finish(&mut log, state);
                // whoever asked may have given up
                let _ = done.send(());
                return;
            }
            Err(RecvTimeoutError::Timeout) => flush = true,
            Err(RecvTimeoutError::Disconnected) => return finish(&mut log, state),
        }
        if flush {
            state.note_failure(log.flush().err().as_ref());
            state.count(log.get_mut());
            due = Instant::now() + FLUSH;
        }
        if let Some(done) = waiting {
            // whoever asked may have given up
            let _ = done.send(());
        }
    }
}

/// The last try: what the store does not take now is lost.
fn finish<S: Store>(log: &mut TlogWriter<Backlog<S>>, state: &State) {
    state.note_failure(log.flush().err().as_ref());
    state.count(log.get_mut());
    state.dropped.fetch_add(log.get_mut().records(), Ordering::Relaxed);
}
