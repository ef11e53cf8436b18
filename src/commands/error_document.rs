//! The document of a command that failed, for a script that asked for one with `--json`.

use serde::Serialize;

use super::CommandError;
use super::last_word::last_word;
use super::{output, said};

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

/// Says on standard error why a command failed and, with `json`, on standard output as a document, unless one is there. Returns the
/// exit status.
pub fn failed(error: &CommandError, json: bool) -> u8 {
    let status = error.report();
    if json {
        let said = said::lines();
        print(if said.is_empty() { vec![error.to_string()] } else { said }, status);
    }
    status
}

/// Prints the document of a failure that these lines tell. A reader that takes nothing does not keep the program from ending.
pub fn print(lines: Vec<String>, exit_status: u8) {
    if said::is_document_printed() {
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
