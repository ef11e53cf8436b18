//! What is said where it may be that nobody takes it.

use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// How long the end of a flight waits for a terminal.
pub const PATIENCE: Duration = Duration::from_secs(3);
/// How long the last word of a program may take.
pub const LAST_WORD: Duration = Duration::from_millis(300);

/// Does something that may never end on a thread of its own, and waits so long for what it gives.
pub fn within<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let (done, over) = channel();
    let begun = thread::Builder::new().name("last word".into()).spawn(move || {
        // whoever asked may have given up
        let _ = done.send(work());
    });
    begun.ok().and_then(|_| over.recv_timeout(limit).ok())
}

/// Does something that may never end, and waits a little for it.
pub fn last_word(say: impl FnOnce() + Send + 'static) {
    let _ = within(LAST_WORD, say);
}
