//! Standard output for results, standard error for the rest.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use super::CommandError;

/// A result for people; ends the line.
pub fn text(text: &str) -> Result<(), CommandError> {
    line(io::stdout().lock(), text)
}

/// A result as one JSON document.
pub fn json(document: &impl Serialize) -> Result<(), CommandError> {
    let text = serde_json::to_string_pretty(document)
        .map_err(|error| CommandError::Failure(format!("cannot write JSON: {error}")))?;
    line(io::stdout().lock(), &text)
}

/// Progress, warnings and errors. Where standard error is closed there is nobody to tell.
pub fn message(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A file of the user's choice.
pub fn file(path: &Path, text: &str) -> Result<(), CommandError> {
    std::fs::write(path, text)
        .map_err(|error| CommandError::Input(format!("cannot write {}: {error}", path.display())))
}

/// A reader that has seen enough (`mavid ... | head`) is not a failure.
fn line(mut out: impl Write, text: &str) -> Result<(), CommandError> {
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(CommandError::Failure(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
