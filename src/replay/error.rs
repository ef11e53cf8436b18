//! Why a log cannot be played back.

use std::path::{Path, PathBuf};

use crate::link::LinkError;
use crate::log::LogError;
use crate::text;

/// Why a log cannot be played back.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// it cannot be read
    #[error("{}", of_file(path, source))]
    Log {
        /// which file
        path: PathBuf,
        /// why
        source: LogError,
    },
    /// the speed is no speed
    #[error("expected a speed of 0 (as fast as possible) or more, got {got}")]
    Speed {
        /// what was given
        got: f64,
    },
    /// the link it should go to has ended
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// An error of opening names the file itself.
fn of_file(path: &Path, error: &LogError) -> String {
    match error {
        LogError::Open { .. } => error.to_string(),
        _ => format!("{}: {error}", text::path(&path)),
    }
}
