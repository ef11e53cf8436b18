//! The document of a command that failed, for a script that asked for one with `--json`.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;

use super::CommandError;
use super::last_word::last_word;
use super::output;

/// A document was printed: a failure after it adds none.
static PRINTED: AtomicBool = AtomicBool::new(false);
/// What was said of the failure on standard error, line by line.
static SAID: Mutex<Vec<String>> = Mutex::new(Vec::new());
/// What a line of the program begins with on standard error.
const PROGRAM: &str = "mavid: ";

#[derive(Serialize)]
struct Document {
    schema: u32,
    error: ErrorValue,
}

#[derive(Serialize)]
struct ErrorValue {
    message: String,
    exit_status: u8,
}

/// A document goes to standard output.
pub fn is_printed() {
    PRINTED.store(true, Ordering::SeqCst);
}

/// A line about the failure goes to standard error.
pub fn is_said(line: &str) {
    SAID.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
}

/// Says on standard error why a command failed and, with `json`, on standard output as a document, unless one is there. Returns the
/// exit status.
pub fn failed(error: &CommandError, json: bool) -> u8 {
    let status = error.report();
    if json {
        let said = SAID.lock().unwrap_or_else(PoisonError::into_inner).clone();
        print(if said.is_empty() { vec![error.to_string()] } else { said }, status);
    }
    status
}

/// Prints the document of a failure that these lines tell. A reader that takes nothing does not keep the program from ending.
pub fn print(lines: Vec<String>, exit_status: u8) {
    if PRINTED.load(Ordering::SeqCst) {
        return;
    }
    let lines: Vec<&str> = lines.iter().map(|line| line.strip_prefix(PROGRAM).unwrap_or(line)).collect();
    let message = lines.join("; ");
    let document = Document { schema: 1, error: ErrorValue { message, exit_status } };
    last_word(move || {
        // the reason is on standard error as well
        let _ = output::json(&document);
    });
}
