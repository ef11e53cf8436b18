//! Why there is no recording.

use std::io;
use std::path::PathBuf;

use crate::text;

/// Why there is no recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// the file is there already
    #[error("{} exists already", text::path(path))]
    Exists {
        /// which file
        path: PathBuf,
    },
    /// the file cannot be made
    #[error("cannot write {}: {source}", text::path(path))]
    Create {
        /// which file
        path: PathBuf,
        /// what the system said
        source: io::Error,
    },
    /// no thread for it
    #[error("cannot start the thread that writes the recording: {0}")]
    Thread(io::Error),
    /// the thread is gone
    #[error("the recording has ended")]
    Ended,
}
