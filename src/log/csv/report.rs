//! What was read of a table and what was left out.

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

/// A row that was left out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowRejection {
    /// line in the file, the header being 1
    pub line: u64,
    /// what was expected and what came
    pub reason: String,
}
