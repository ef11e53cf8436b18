//! A file that went in, as results name it.

use std::path::Path;

use crate::note::{About, Note, Severity, said_once};
use crate::text;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Serialize, Serializer};
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::fmt::Write;

use super::StudyError;

/// One file that went in, or one flight of a log that holds several.
#[derive(Debug, Clone, PartialEq)]
pub struct InputFile {
    /// file name as given, and which flight of it where it holds several
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal
    pub sha256: String,
    /// other logs of the same flight that were put together with it: path and SHA-256
    pub other_logs: Vec<(String, String)>,
    /// what of it was lost on reading, and what else is to be known of it: whose flight it is, what is no flight
    pub notes: Vec<Note>,
}

impl InputFile {
    /// A file with its hash.
    ///
    /// # Errors
    /// [`StudyError::File`] where it cannot be read.
    pub fn of(path: &Path) -> Result<Self, StudyError> {
        let sha256 = sha256_of(path)
            .map_err(|error| StudyError::File { file: text::path(&path), why: error.to_string() })?;
        Ok(Self { path: text::path(&path), sha256, other_logs: Vec::new(), notes: Vec::new() })
    }

    /// Another log of the same flight was put together with it.
    pub(super) fn add_log(&mut self, other: Self) {
        self.other_logs.push((other.path, other.sha256));
        self.notes.extend(other.notes);
    }

    /// Path and SHA-256 of each of its files.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        let others = self.other_logs.iter().map(|(path, sha256)| (path.as_str(), sha256.as_str()));
        std::iter::once((self.path.as_str(), self.sha256.as_str())).chain(others)
    }

    /// What of it was not read or not used: sentence by sentence.
    #[must_use]
    pub fn losses(&self) -> Vec<String> {
        self.notes.iter().filter(|note| note.severity == Severity::Loss).map(|note| self.text(note)).collect()
    }

    /// What else is to be known of it, and of flights of its log that were left out.
    pub fn remarks(&self) -> impl Iterator<Item = &Note> {
        self.notes.iter().filter(|note| note.severity != Severity::Loss)
    }

    /// A note beside the name of the file: one about another flight of its log, or another log of the flight, says so.
    fn text(&self, note: &Note) -> String {
        match &note.about {
            About::File(path) if *path != self.path => note.sentence(),
            _ => note.text.clone(),
        }
    }
}

/// What of the files was not read or not used: a warning for each that is damaged; the same of several once. Every view of a result says it.
#[must_use]
pub fn lost<'a>(inputs: impl IntoIterator<Item = &'a InputFile>) -> Vec<Note> {
    let damaged = inputs.into_iter().filter_map(|input| match input.losses() {
        losses if losses.is_empty() => None,
        losses => Some(Note::warning(About::File(input.path.clone()), losses.join("; "))),
    });
    said_once(damaged.collect())
}

/// All that is to be known of the files: what of them was lost, and what else was said of them.
#[must_use]
pub fn said_of<'a>(inputs: impl IntoIterator<Item = &'a InputFile> + Clone) -> Vec<Note> {
    let others = inputs.clone().into_iter().flat_map(InputFile::remarks).cloned();
    said_once(lost(inputs).into_iter().chain(others).collect())
}

/// `{"path", "sha256", "other_logs", "losses", "notes"}`, the third and the last only where there are some.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "InputFile")]
struct Written<'a> {
    path: &'a str,
    sha256: &'a str,
    /// of the same flight
    #[serde(skip_serializing_if = "Vec::is_empty")]
    other_logs: Vec<OtherLog<'a>>,
    /// what of it was not read or not used: sentence by sentence
    losses: Vec<String>,
    /// what else is to be known of it
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<String>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "OtherLog")]
struct OtherLog<'a> {
    path: &'a str,
    sha256: &'a str,
}

impl JsonSchema for InputFile {
    fn schema_name() -> Cow<'static, str> {
        Written::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Written::json_schema(generator)
    }
}

impl Serialize for InputFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (losses, notes) = (self.losses(), self.remarks().map(|note| self.text(note)).collect());
        let other_logs = self.other_logs.iter().map(|(path, sha256)| OtherLog { path, sha256 }).collect();
        Written { path: &self.path, sha256: &self.sha256, other_logs, losses, notes }.serialize(serializer)
    }
}

fn sha256_of(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    std::io::copy(&mut std::fs::File::open(path)?, &mut hasher)?;
    Ok(hasher.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::note::About;

    #[test]
    fn losses_and_remarks_are_written_apart() {
        let about = || About::File("a.tlog".to_owned());
        let notes = vec![Note::remark(about(), "two vehicles"), Note::loss(about(), "3 bytes cut off")];
        let input =
            InputFile { path: "a.tlog".to_owned(), sha256: "0".to_owned(), other_logs: Vec::new(), notes };
        let expected =
            r#"{"path":"a.tlog","sha256":"0","losses":["3 bytes cut off"],"notes":["two vehicles"]}"#;
        assert_eq!(text::json_line(&input).unwrap(), expected);
        let told: Vec<String> = said_of([&input]).iter().map(ToString::to_string).collect();
        assert_eq!(told, ["warning: a.tlog: 3 bytes cut off", "a.tlog: two vehicles"]);
        assert_eq!(lost([&input]).len(), 1);
        let whole = InputFile { notes: Vec::new(), ..input };
        assert!(lost([&whole]).is_empty());
        assert!(text::json_line(&whole).unwrap().ends_with(r#""losses":[]}"#));
    }

    #[test]
    fn a_note_about_another_flight_of_the_log_keeps_its_name() {
        let of = |path: &str, text: &str| Note::remark(About::File(path.to_owned()), text);
        let [first, second] = ["a.bin, flight 1 of 2", "a.bin, flight 2 of 2"];
        let input = InputFile {
            path: second.to_owned(),
            sha256: "0".to_owned(),
            other_logs: Vec::new(),
            notes: vec![of(first, "left out: too short"), of(second, "slow")],
        };
        let told: Vec<String> = said_of([&input]).iter().map(ToString::to_string).collect();
        assert_eq!(told, ["a.bin, flight 1 of 2: left out: too short", "a.bin, flight 2 of 2: slow"]);
        let written = text::json_line(&input).unwrap();
        assert!(
            written.ends_with(r#""notes":["a.bin, flight 1 of 2: left out: too short","slow"]}"#),
            "{written}"
        );
    }
}
