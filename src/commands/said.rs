//! What a command has put out so far, which the document of a failure follows.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// A document was printed: a failure after it adds none.
static PRINTED: AtomicBool = AtomicBool::new(false);
/// What was said of the failure on standard error, line by line.
static SAID: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// A document goes to standard output.
pub fn document_is_printed() {
    PRINTED.store(true, Ordering::SeqCst);
}

/// Whether one did.
pub fn is_document_printed() -> bool {
    PRINTED.load(Ordering::SeqCst)
}

/// A line about the failure goes to standard error.
pub fn line_is_said(line: &str) {
    SAID.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
}

/// All such lines.
pub fn lines() -> Vec<String> {
    SAID.lock().unwrap_or_else(PoisonError::into_inner).clone()
}
