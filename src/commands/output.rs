//! Standard output for results, standard error for the rest.

use std::collections::BTreeMap;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use mavid::files::write_whole;
use mavid::link::Signing;
use mavid::note::Note;
use mavid::text;
use serde::Serialize;

use super::columns::{of_terminal, size_of_terminal};
use super::standard_error::MESSAGE;
use super::{CommandError, NOT_ALL, said};

/// A result for people; ends the line. On a terminal lines that are longer than it is wide are broken between words.
pub fn text(text: &str) -> Result<(), CommandError> {
    let text = text::clean_lines(text);
    let columns = of_terminal().filter(|_| io::stdout().is_terminal());
    match columns {
        Some(columns) => line(io::stdout().lock(), &to_columns(&text, columns)),
        None => line(io::stdout().lock(), &text),
    }
}

/// Standard output is a terminal.
pub fn is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Standard output and standard error are terminals: for people one and the same.
pub fn is_one_terminal() -> bool {
    is_terminal() && io::stderr().is_terminal()
}

/// Lines below a result for people that is longer than its terminal is high: what stood at its top is out of sight. They are made
/// for its columns. Nothing where there is no terminal.
pub fn once_more(result: &str, lines: impl FnOnce(usize) -> String) -> Result<(), CommandError> {
    match size_of_terminal().filter(|_| io::stdout().is_terminal()) {
        Some((columns, rows)) if is_higher(result, (columns, rows)) => text(&format!("\n{}", lines(columns))),
        _ => Ok(()),
    }
}

/// Whether a text, with the lines of the shell around it, takes more rows than a terminal has.
fn is_higher(text: &str, (columns, rows): (usize, usize)) -> bool {
    to_columns(text, columns).lines().count() + SHELL_ROWS > rows
}

/// Rows of a terminal that a command and the prompt behind it take.
const SHELL_ROWS: usize = 2;

/// What is a file for another program; ends the line. Its lines stay as they are.
pub fn file_text(text: &str) -> Result<(), CommandError> {
    line(io::stdout().lock(), &text::clean_lines(text))
}

/// The same lines, none of which a terminal breaks within a word.
fn to_columns(text: &str, columns: usize) -> String {
    text.split('\n').flat_map(|line| text::to_width(line, columns)).collect::<Vec<_>>().join("\n")
}

/// A result as one JSON document.
pub fn json(document: &impl Serialize) -> Result<(), CommandError> {
    self::document(&json_text(document)?)
}

/// A document that is text already.
pub fn document(text: &str) -> Result<(), CommandError> {
    said::document_is_printed();
    line(io::stdout().lock(), text)
}

/// A document as the text of a file.
pub fn json_text(document: &impl Serialize) -> Result<String, CommandError> {
    text::json_pretty(document).map_err(|error| CommandError::Failure(format!("cannot write JSON: {error}")))
}

/// What goes on, on one line of standard error, whatever of foreign words is in it; nothing where it is to be quiet.
/// Where standard error is closed there is nobody to tell.
pub fn message(text: &str) {
    tracing::info!(target: MESSAGE, message = text);
}

/// What the user should know: the same, after `warning: `. Each is said once, however many steps of a run find it.
pub fn warning(text: &str) {
    if SAID.is_news(text, true) {
        tracing::warn!(target: MESSAGE, message = text);
    }
}

/// What was said since the program began.
static SAID: Said = Said(Mutex::new(BTreeMap::new()));
/// So many sentences are remembered; further ones may be said again.
const REMEMBERED: usize = 1000;

/// Sentences, and whether each was said as a warning.
struct Said(Mutex<BTreeMap<String, bool>>);

impl Said {
    /// It was not said yet, or not as a warning and is one now.
    fn is_news(&self, text: &str, is_warning: bool) -> bool {
        let mut said = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if said.get(text).is_some_and(|was_warning| *was_warning || !is_warning) {
            return false;
        }
        if said.len() < REMEMBERED {
            said.insert(text.to_owned(), is_warning);
        }
        true
    }
}

/// Why the work is not done: a message also where it is to be quiet.
pub fn error(text: &str) {
    said::line_is_said(text);
    tracing::error!(target: MESSAGE, message = text);
}

impl CommandError {
    /// Says it on standard error, unless that was done, and gives the exit status.
    pub fn report(&self) -> u8 {
        self.words().iter().for_each(|line| error(line));
        self.status()
    }

    /// What is to be said of it, line by line; nothing where that was done.
    pub fn words(&self) -> Vec<String> {
        match self {
            Self::Reported(_) => Vec::new(),
            Self::Inputs(lines) => lines.iter().map(|line| format!("mavid: {line}")).collect(),
            one => vec![format!("mavid: {one}")],
        }
    }

    /// The exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Inputs(_) => 2,
            Self::Failure(_) => 1,
            Self::Ended(_) => NOT_ALL,
            Self::Reported(status) => *status,
        }
    }
}

/// What is hardly meant in a file.
pub fn warnings(of: &Path, warnings: &[Note]) {
    let of = text::path(&of);
    warnings.iter().for_each(|warning| note(&warning.of_file(&of)));
}

/// What is to be known beside a result; once, as a warning.
pub fn note(note: &Note) {
    let sentence = note.sentence();
    if note.is_warning() {
        warning(&sentence);
    } else if SAID.is_news(&sentence, false) {
        message(&sentence);
    }
}

/// What is odd about the files of a signing key.
pub fn signing_warnings(signing: Option<&Signing>) {
    signing.iter().flat_map(|signing| signing.warnings()).for_each(note);
}

/// Refuses a file that is there already, unless it may be replaced.
pub fn refuse_replacing(out: &Path, force: bool) -> Result<(), CommandError> {
    if force || !out.exists() {
        return Ok(());
    }
    let what =
        format!("--out: expected a new file, got {}, which exists; --force replaces it", text::path(&out));
    Err(CommandError::Input(what))
}

/// A file of the user's choice; where it cannot be written whole, what was there before stays.
pub fn file(path: &Path, text: &str) -> Result<(), CommandError> {
    bytes(path, text.as_bytes())
}

/// The same of bytes.
pub fn bytes(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    folder_of(path)?;
    write_whole(path, bytes)
        .map_err(|error| CommandError::Input(format!("cannot write {}: {error}", text::path(&path))))
}

/// Removes a file of an earlier run that this one has nothing to put in the place of; what is to be said of that.
pub fn outdated(path: &Path) -> Result<Option<String>, CommandError> {
    match std::fs::remove_file(path) {
        Ok(()) => Ok(Some(format!("removed {}, of an earlier run", text::path(&path)))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => {
            let told = format!("cannot remove {}, of an earlier run: {error}", text::path(&path));
            Err(CommandError::Input(told))
        }
    }
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

/// Makes a folder for results where there is none, and says so.
pub fn folder(path: &Path) -> Result<(), CommandError> {
    if path.as_os_str().is_empty() || path.is_dir() {
        return Ok(());
    }
    silent_folder(path)?;
    message(&format!("made the folder {}", text::path(&path)));
    Ok(())
}

/// Makes a folder without a word: before a flight a terminal that takes nothing must not be waited for.
pub fn silent_folder(path: &Path) -> Result<(), CommandError> {
    std::fs::create_dir_all(path)
        .map_err(|error| CommandError::Input(format!("cannot make {}: {error}", text::path(&path))))
}

/// Refuses a folder that cannot be made, and leaves none behind: the work comes first, and may have no result.
pub fn can_make_folder(path: &Path) -> Result<(), CommandError> {
    let missing: Vec<&Path> =
        path.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let made = silent_folder(path);
    for folder in missing {
        // what could not be made is not there, and what holds anything stays
        let _ = std::fs::remove_dir(folder);
    }
    made
}

/// Makes the folder of a file that is to be written, as [`folder`] does.
pub fn folder_of(file: &Path) -> Result<(), CommandError> {
    file.parent().map_or(Ok(()), folder)
}

/// Both name one file, however they are written.
pub fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    real(one) == real(other)
}

/// Results do not overwrite what they come from, nor each other.
pub fn refuse_overwriting(inputs: &[&PathBuf], outputs: &[&PathBuf]) -> Result<(), CommandError> {
    for (index, output) in outputs.iter().enumerate() {
        if inputs.iter().any(|input| is_same(input, output)) {
            return Err(CommandError::Input(format!(
                "expected another file for the results: {} is an input",
                text::path(&output)
            )));
        }
        if outputs[..index].iter().any(|other| is_same(other, output)) {
            return Err(CommandError::Input(format!(
                "expected a file of its own for each result: {} is given for two",
                text::path(&output)
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_that_fits_is_not_summed_up() {
        assert!(!is_higher(&"line\n".repeat(22), (80, 24)) && is_higher(&"line\n".repeat(23), (80, 24)));
        // lines that are broken take more rows
        assert!(is_higher(&format!("{}\n", "word ".repeat(30)).repeat(12), (80, 24)));
    }

    #[test]
    fn a_sentence_is_said_once_and_once_more_as_a_warning() {
        let said = Said(Mutex::default());
        assert!(said.is_news("rests on guesses", false) && !said.is_news("rests on guesses", false));
        assert!(said.is_news("rests on guesses", true) && !said.is_news("rests on guesses", true));
        assert!(!said.is_news("rests on guesses", false) && said.is_news("another", true));
    }
}
