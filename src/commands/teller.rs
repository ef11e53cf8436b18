//! Tells what goes on without ever waiting for who reads it.

use std::io::{IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use mavid::text;
use ratatui::crossterm::terminal;

use super::{CommandError, output};

/// Lines that may wait for standard error.
const WAITING: usize = 1024;
/// Columns of a terminal that does not say how many it has.
const COLUMNS: u16 = 80;

/// Lines for standard error, by a thread of their own. What finds no room is left out, and counted.
#[derive(Debug)]
pub struct Teller {
    to: SyncSender<Told>,
    left_out: Arc<AtomicU64>,
    thread: JoinHandle<()>,
    shows_status: bool,
}

#[derive(Debug)]
enum Told {
    /// stays
    Line(String),
    /// until the next
    Status(String),
}

impl Teller {
    /// Starts it.
    pub fn start() -> Result<Self, CommandError> {
        let (to, told) = sync_channel(WAITING);
        let left_out = Arc::new(AtomicU64::new(0));
        let counted = left_out.clone();
        let thread = thread::Builder::new()
            .name("teller".into())
            .spawn(move || tell(&told, &counted))
            .map_err(|error| CommandError::Failure(format!("cannot start a thread: {error}")))?;
        Ok(Self { to, left_out, thread, shows_status: std::io::stderr().is_terminal() })
    }

    /// A line.
    pub fn message(&self, text: &str) {
        if self.to.try_send(Told::Line(text.to_owned())).is_err() {
            self.left_out.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// How things stand, in place of what was said so last; nothing where there is no terminal.
    pub fn status(&self, text: &str) {
        if self.shows_status {
            // the next one follows soon
            let _ = self.to.try_send(Told::Status(text.to_owned()));
        }
    }

    /// Waits until all is told.
    pub fn finish(self) {
        drop(self.to);
        // one that panicked says no more
        let _ = self.thread.join();
    }
}

fn tell(told: &Receiver<Told>, left_out: &AtomicU64) {
    let mut stands = false;
    for told in told {
        match told {
            Told::Line(line) => {
                clear(&mut stands);
                output::message(&line);
            }
            Told::Status(status) => {
                clear(&mut stands);
                draw(&status);
                stands = true;
            }
        }
        let missed = left_out.swap(0, Ordering::Relaxed);
        if missed > 0 {
            output::message(&format!(
                "warning: {missed} lines are not shown: standard error took them too slowly"
            ));
        }
    }
    clear(&mut stands);
}

/// Takes a status away. Where standard error is closed there is nobody to tell.
fn clear(stands: &mut bool) {
    if std::mem::take(stands) {
        let _ = write!(std::io::stderr().lock(), "\r\x1b[K");
    }
}

fn draw(status: &str) {
    let columns = usize::from(terminal::size().map_or(COLUMNS, |(columns, _)| columns.max(2)));
    let shown: String = text::clean(status).chars().take(columns - 1).collect();
    let mut terminal = std::io::stderr().lock();
    let _ = write!(terminal, "{shown}").and_then(|()| terminal.flush());
}
