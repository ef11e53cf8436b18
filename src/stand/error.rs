//! Why a table of a thrust stand cannot be used.

use crate::text;
use std::path::PathBuf;

/// Why a table of a thrust stand cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StandError {
    /// it cannot be read
    #[error("cannot read {}: {source}", text::path(path))]
    Read {
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// more bytes than such a table has
    #[error(
        "{}: expected a table of a thrust stand of at most {max} bytes, got a larger file",
        text::path(path)
    )]
    TooLarge {
        /// which file
        path: PathBuf,
        /// the most that it may have
        max: u64,
    },
    /// columns that are missing, twice there, or without a unit
    #[error("expected {expected}, got {came}")]
    Columns {
        /// what would have been right
        expected: String,
        /// what the header says
        came: String,
    },
    /// rows that say too little, or what no rotor does
    #[error("expected {expected}, got {came}")]
    Rows {
        /// what would have been right
        expected: String,
        /// what the rows say
        came: String,
    },
}
