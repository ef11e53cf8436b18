//! Words for streams that may take nothing: a terminal that stands still, a pipe that nobody reads.

use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use super::output;

/// How long the end of a flight waits for a terminal, each time until it was seen to stand still.
pub const PATIENCE: Duration = Duration::from_secs(3);
/// How long the last word of a program may take.
const LAST_WORD: Duration = Duration::from_millis(300);

/// Does something that may never end on a thread of its own, and waits so long for what it gives.
pub fn within<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (done, over) = channel();
    let begun = thread::Builder::new().name("words".into()).spawn(move || {
        // whoever asked may have given up
        let _ = done.send(work());
    });
    begun.ok().and_then(|_| over.recv_timeout(limit).ok())
}

/// Says something that may not be heard, and waits a little for it.
pub fn last_word(say: impl FnOnce() + Send + 'static) {
    let _ = within(LAST_WORD, say);
}

/// Says what there is to say on standard error until that takes nothing, and nothing from then on.
#[derive(Debug)]
pub struct Words {
    heard: bool,
}

impl Words {
    /// Where the terminal is known to stand still, nothing is said.
    pub fn new(heard: bool) -> Self {
        Self { heard }
    }

    /// Says these lines.
    pub fn say(&mut self, lines: Vec<String>) {
        if self.heard && !lines.is_empty() {
            let work = move || lines.iter().for_each(|line| output::message(line));
            self.heard = within(PATIENCE, work).is_some();
        }
    }

    /// All was said so far, and taken.
    pub fn are_heard(&self) -> bool {
        self.heard
    }
}
