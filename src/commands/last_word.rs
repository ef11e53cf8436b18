//! What is said at the end of a program, whether or not somebody takes it.

use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// How long the last word of a program may take.
const LAST_WORD: Duration = Duration::from_millis(300);

/// Does something that may never end, and waits a little for it.
pub fn last_word(say: impl FnOnce() + Send + 'static) {
    let (done, over) = channel();
    let said = thread::Builder::new().name("last word".into()).spawn(move || {
        say();
        let _ = done.send(());
    });
    if said.is_ok() {
        let _ = over.recv_timeout(LAST_WORD);
    }
}
