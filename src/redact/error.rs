//! Why a log cannot be redacted.

use thiserror::Error;

/// Why a log cannot be redacted.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum RedactError {
    /// not one of the formats
    #[error("expected a .tlog, .ulg or .bin recording, found a file that begins with {0}")]
    Unknown(String),
    /// no bytes
    #[error("expected a .tlog, .ulg or .bin recording, got an empty file: nothing was recorded into it")]
    Empty,
    /// nothing of it could be read
    #[error("expected messages of {format}, found none in {bytes} bytes")]
    Nothing {
        /// format
        format: &'static str,
        /// of the file
        bytes: usize,
    },
    /// the redacted log, read back, still holds something
    #[error("read back, the redacted log still holds {what}: nothing was written")]
    StillThere {
        /// what
        what: String,
    },
}
