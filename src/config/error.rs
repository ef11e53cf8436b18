//! What is wrong with a configuration file.

use std::path::PathBuf;

use super::form::MOST_FAULTS;
use crate::log::csv::CsvError;
use crate::text;

/// Why a configuration file was refused.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// the file could not be read
    #[error("cannot read {}: {source}", text::path(path))]
    Read {
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// a table whose columns cannot be read
    #[error(transparent)]
    Table(#[from] CsvError),
    /// a recording
    #[error("{}: expected {expected}, got a recording, {came}: give it among the logs", text::path(path))]
    Recording {
        /// which file
        path: PathBuf,
        /// what it was to be
        expected: &'static str,
        /// its format
        came: &'static str,
    },
    /// bytes that are no text
    #[error("{}: expected {expected}, got a file that is not text", text::path(path))]
    NoText {
        /// which file
        path: PathBuf,
        /// what it was to be
        expected: &'static str,
    },
    /// more bytes than such a file may have
    #[error("{}: expected {expected} of at most {max} bytes, got a larger file", text::path(path))]
    TooLarge {
        /// which file
        path: PathBuf,
        /// what it was to be
        expected: &'static str,
        /// the most that it may have
        max: u64,
    },
    /// a file of another kind
    #[error("{origin}: expected {expected}, got {came}")]
    OtherKind {
        /// file name, or what the text is
        origin: String,
        /// what it was to be
        expected: &'static str,
        /// what it is, by its keys
        came: String,
    },
    /// not TOML, a key that does not exist, a key that is missing, or a value of the wrong kind
    #[error("{origin}: expected {expected}: {reason}")]
    Parse {
        /// file name, or what the text is
        origin: String,
        /// what it was to be
        expected: &'static str,
        /// line, column, what stands there and what is wrong with it
        reason: String,
    },
    /// a form that a later version of the program has
    #[error(
        "{origin}: `format`: expected {known} or no such key, got {came}: a later version of mavid wrote this file; use that \
         version, or make the file again with this one (`mavid vehicle init` drafts a vehicle file, `mavid identify` and `mavid \
         explain` write a model with --out)"
    )]
    Format {
        /// file name, or what the text is
        origin: String,
        /// the latest that is known
        known: u32,
        /// what the file says
        came: i64,
    },
    /// a value, or several together, that cannot be
    #[error("{origin}: `{key}`: expected {expected}, got {came}")]
    Invalid {
        /// file name, or what the text is
        origin: String,
        /// key with its table, `body.mass`
        key: String,
        /// what would have been right
        expected: String,
        /// what the file says
        came: String,
    },
    /// more than one of these in one file, as far as they are looked for
    #[error("{origin}: {}: {}", errors_are(.errors.len()), joined(.errors))]
    Several {
        /// file name, or what the text is
        origin: String,
        /// each names the file again
        errors: Vec<ConfigError>,
    },
    /// a value that cannot be written as TOML
    #[error("cannot write as TOML: {0}")]
    Write(#[from] toml::ser::Error),
}

impl ConfigError {
    /// All of a file's as one; of one error that itself.
    pub(super) fn combined(origin: &str, mut errors: Vec<Self>) -> Self {
        match errors.pop() {
            Some(one) if errors.is_empty() => one,
            last => {
                errors.extend(last);
                Self::Several { origin: origin.to_owned(), errors }
            }
        }
    }

    /// As lines: for each error one, and before several how many there are.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        match self {
            Self::Several { origin, errors } => {
                std::iter::once(format!("{origin}: {}", errors_are(errors.len())))
                    .chain(errors.iter().map(ToString::to_string))
                    .collect()
            }
            one => vec![one.to_string()],
        }
    }
}

fn errors_are(count: usize) -> String {
    let more = if count >= MOST_FAULTS { " or more" } else { "" };
    format!("{count}{more} errors")
}

fn joined(errors: &[ConfigError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
