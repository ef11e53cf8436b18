//! Lines that are told by a thread of its own, so that whoever says them waits for nobody.

use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use mavid::text;
use ratatui::crossterm::terminal;

use super::lines::Lines;

/// Lines that may wait for standard error.
const WAITING: usize = 1024;
/// Columns of a terminal that does not say how many it has.
const COLUMNS: u16 = 80;

/// Lines for standard error, by a thread of their own. What finds no room is left out, and counted.
#[derive(Debug)]
pub(super) struct Teller {
    to: SyncSender<TellerMessage>,
    left_out: Arc<AtomicU64>,
}

#[derive(Debug)]
enum TellerMessage {
    /// stays
    Line(String),
    /// until the next
    Status(String),
    /// all before it was told
    Flush(Sender<()>),
}

impl Teller {
    /// Starts it.
    pub(super) fn start(lines: Arc<Lines>) -> io::Result<Self> {
        let (to, told) = sync_channel(WAITING);
        let left_out = Arc::new(AtomicU64::new(0));
        let counted = left_out.clone();
        thread::Builder::new().name("teller".into()).spawn(move || tell(&told, &lines, &counted))?;
        Ok(Self { to, left_out })
    }

    /// A line, which is clean already.
    pub(super) fn line(&self, line: String) {
        if self.to.try_send(TellerMessage::Line(line)).is_err() {
            self.left_out.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// How things stand, in place of what was said so last.
    pub(super) fn status(&self, text: &str) {
        // the next one follows soon
        let _ = self.to.try_send(TellerMessage::Status(text::clean(text)));
    }

    /// Waits until all is told, and takes the status away.
    pub(super) fn flush(&self) {
        let (done, told) = channel();
        // one that panicked says no more
        if self.to.send(TellerMessage::Flush(done)).is_ok() {
            let _ = told.recv();
        }
    }
}

fn tell(told: &Receiver<TellerMessage>, lines: &Lines, left_out: &AtomicU64) {
    let mut stands = false;
    for told in told {
        clear(lines, &mut stands);
        match told {
            TellerMessage::Line(line) => lines.write(&line),
            TellerMessage::Status(status) => {
                draw(lines, &status);
                stands = true;
            }
            TellerMessage::Flush(done) => {
                tell_missing(lines, left_out);
                // whoever asked may have given up
                let _ = done.send(());
                continue;
            }
        }
        if !stands {
            tell_missing(lines, left_out);
        }
    }
}

fn tell_missing(lines: &Lines, left_out: &AtomicU64) {
    let missed = left_out.swap(0, Ordering::Relaxed);
    if missed > 0 {
        lines.write(&format!("warning: {missed} lines are not shown: standard error took them too slowly"));
    }
}

/// Takes a status away. Where standard error is closed there is nobody to tell.
fn clear(lines: &Lines, stands: &mut bool) {
    if std::mem::take(stands) {
        lines.draw(|terminal| write!(terminal, "\r\x1b[K"));
    }
}

fn draw(lines: &Lines, status: &str) {
    let columns = usize::from(terminal::size().map_or(COLUMNS, |(columns, _)| columns.max(2)));
    let shown: String = status.chars().take(columns - 1).collect();
    lines.draw(|terminal| write!(terminal, "{shown}").and_then(|()| terminal.flush()));
}
