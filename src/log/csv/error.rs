//! Why a file gave no recording.

use crate::log::loss::RowRejection;
use crate::text;

/// Characters of a column's name that an error repeats.
const NAME_CHARS: usize = 64;

/// Why a file gave no recording.
#[derive(Debug, thiserror::Error)]
pub enum CsvError {
    /// reading stopped in the middle
    #[error("{origin}: {source}")]
    Table {
        /// file name, or what the bytes are
        origin: String,
        /// what the CSV reader or the system said
        source: ::csv::Error,
    },
    /// a column that the mapping names is not in the header
    #[error(
        "{origin}: expected column(s) {}, but the header has {}: name them as configs/csv/default.toml does, or say with \
         --csv-map which is which",
        text::listed(missing.iter()),
        listed(present)
    )]
    MissingColumns {
        /// file name, or what the bytes are
        origin: String,
        /// what the mapping asks for
        missing: Vec<String>,
        /// what the header has
        present: Vec<String>,
    },
    /// no text at all
    #[error("{origin}: expected text with a header of column names in its first line, got {what}")]
    NoText {
        /// file name, or what the bytes are
        origin: String,
        /// what came
        what: &'static str,
    },
    /// the first line does not end
    #[error("{origin}: expected a header of column names of at most {max} bytes, came a longer first line")]
    LongHeader {
        /// file name, or what the bytes are
        origin: String,
        /// the most that it may have
        max: usize,
    },
    /// more columns than a table may have
    #[error("{origin}: expected at most {max} columns, the header has {came}")]
    ManyColumns {
        /// file name, or what the bytes are
        origin: String,
        /// the most that it may have
        max: usize,
        /// what it has
        came: usize,
    },
    /// a column name stands twice in the header
    #[error("{origin}: column \"{}\" stands twice in the header", text::excerpt(column, NAME_CHARS))]
    RepeatedColumn {
        /// file name, or what the bytes are
        origin: String,
        /// the name
        column: String,
    },
    /// the mapping found no quantity besides time
    #[error(
        "{origin}: none of the mapped quantities is in the header, which has {}: say with --csv-map which is which (`mavid csv-map` \
         proposes it)",
        text::listed(present.iter())
    )]
    NothingMapped {
        /// file name, or what the bytes are
        origin: String,
        /// what the header has
        present: Vec<String>,
    },
    /// not one row could be used
    #[error(
        "{origin}: expected rows of numbers, but of {rows} row(s) none was usable{}",
        first_reason(first)
    )]
    NoRows {
        /// file name, or what the bytes are
        origin: String,
        /// rows after the header
        rows: usize,
        /// the first row's fault
        first: Option<RowRejection>,
    },
}

/// The header's columns.
fn listed(present: &[String]) -> String {
    if present.iter().all(String::is_empty) { "none".to_owned() } else { text::listed(present.iter()) }
}

fn first_reason(first: &Option<RowRejection>) -> String {
    first.as_ref().map_or_else(String::new, |row| format!(" (line {}: {})", row.line, row.reason))
}
