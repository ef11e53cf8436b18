//! What is wrong with a configuration file.

use std::path::PathBuf;

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
    /// a form that no version of the program up to this one has
    #[error(
        "{origin}: `format`: expected {known} or no such key, got {came}: a later version of mavid wrote this file; read it \
         with that version, or write it again with this one"
    )]
    Format {
        /// file name, or what the text is
        origin: String,
        /// the latest that is known
        known: u32,
        /// what the file says
        came: String,
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
    /// a value that cannot be written as TOML
    #[error("cannot write as TOML: {0}")]
    Write(#[from] toml::ser::Error),
}
