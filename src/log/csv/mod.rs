//! Flights as tables of comma-separated values: any columns, with a mapping that says what they mean.
//!
//! Rows stream through; what is wrong with one is counted and told, and the rest is kept.

mod bounded;
mod convert;
mod mapping;
mod reader;
mod rows;

pub use mapping::{AttitudeForm, AxisFrame, CsvMapping, CsvQuantity, CsvTime, CsvUnit, column_count};
pub use reader::{read_csv, read_csv_from};

use std::path::PathBuf;

use crate::text;

/// Characters of a column's name that an error repeats.
const NAME_CHARS: usize = 64;

/// Why a file gave no recording.
#[derive(Debug, thiserror::Error)]
pub enum CsvError {
    /// the file could not be read
    #[error("cannot read {}: {source}", text::path(path))]
    Read {
        /// which file
        path: PathBuf,
        /// what the system said
        source: std::io::Error,
    },
    /// reading stopped in the middle
    #[error("{origin}: {source}")]
    Table {
        /// file name, or what the bytes are
        origin: String,
        /// what the CSV reader or the system said
        source: ::csv::Error,
    },
    /// a column that the mapping names is not in the header
    #[error("{origin}: expected column(s) {}, but the header has {}", text::listed(missing.iter()), listed(present))]
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
    #[error("{origin}: none of the mapped quantities is in the header, which has {}", text::listed(present.iter()))]
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

/// A row that was left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowRejection {
    /// line in the file, the header being 1
    pub line: u64,
    /// what was expected and what came
    pub reason: String,
}

/// What was read and what was left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CsvReport {
    /// rows after the header
    pub rows: usize,
    /// rows left out
    pub rows_rejected: usize,
    /// the first of them, at most [`CsvReport::REJECTIONS_KEPT`]
    pub rejections: Vec<RowRejection>,
    /// the line in which a row begins that is longer than a row may be: nothing of the file is read from there on
    pub cut_at_line: Option<u64>,
    /// rows whose time is before that of a row above; sorted into place
    pub rows_out_of_order: usize,
    /// rows with the same time as another; of each such group the first is kept
    pub rows_repeating_a_time: usize,
    /// steps in time of more than a second back or an hour ahead, taken for a clock that started anew
    pub clock_resets: usize,
    /// attitudes left out: quaternions whose norm is not near one
    pub invalid_attitudes: usize,
    /// columns that the mapping does not use
    pub unused_columns: Vec<String>,
    /// what the time column says at the recording's start, s
    pub start_time_s: f64,
}

impl CsvReport {
    /// How many rejected rows are told one by one.
    pub const REJECTIONS_KEPT: usize = 20;

    /// What of the file was left out, in words.
    #[must_use]
    pub fn losses(&self) -> Vec<String> {
        let mut losses = Vec::new();
        if self.rows_rejected > 0 {
            let first = self
                .rejections
                .first()
                .map_or_else(String::new, |row| format!(", the first in line {}: {}", row.line, row.reason));
            losses.push(format!("{} of {} rows rejected{first}", self.rows_rejected, self.rows));
        }
        if let Some(line) = self.cut_at_line {
            losses.push(format!("nothing is read from line {line} on, whose row has no end"));
        }
        if self.rows_repeating_a_time > 0 {
            losses.push(format!("{} rows repeat a time and were left out", self.rows_repeating_a_time));
        }
        if self.invalid_attitudes > 0 {
            losses.push(format!("{} attitudes are no rotations and were left out", self.invalid_attitudes));
        }
        losses
    }

    /// Whether anything of the file was lost.
    #[must_use]
    pub fn has_loss(&self) -> bool {
        self.rows_rejected + self.rows_repeating_a_time + self.invalid_attitudes > 0
    }
}
