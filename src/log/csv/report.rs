//! What was read of a table and what was left out.

use crate::log::loss::{Loss, RowRejection};

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
    /// line of the first of these
    pub first_repeat_line: Option<u64>,
    /// steps in time of more than a second back or an hour ahead, taken for a clock that started anew
    pub clock_resets: usize,
    /// attitudes left out: quaternions whose norm is not near one
    pub invalid_attitudes: usize,
    /// line of the first of these
    pub first_invalid_attitude_line: Option<u64>,
    /// columns that the mapping does not use
    pub unused_columns: Vec<String>,
    /// what the time column says at the recording's start, s
    pub start_time_s: f64,
}

impl CsvReport {
    /// How many rejected rows are told one by one.
    pub const REJECTIONS_KEPT: usize = 20;

    /// What of the file was left out.
    #[must_use]
    pub fn losses(&self) -> Vec<Loss> {
        let count = |rows: usize| rows as u64;
        let rejected = Loss::RowsRejected {
            count: count(self.rows_rejected),
            of: count(self.rows),
            first: self.rejections.first().cloned(),
        };
        let repeated = Loss::RepeatedTimes {
            count: count(self.rows_repeating_a_time),
            first_line: self.first_repeat_line.unwrap_or(0),
        };
        let no_rotations = Loss::NoRotations {
            count: count(self.invalid_attitudes),
            first_line: self.first_invalid_attitude_line.unwrap_or(0),
        };
        let mut losses = Vec::new();
        losses.extend((self.rows_rejected > 0).then_some(rejected));
        losses.extend(self.cut_at_line.map(|line| Loss::EndlessRow { line }));
        losses.extend((self.rows_repeating_a_time > 0).then_some(repeated));
        losses.extend((self.invalid_attitudes > 0).then_some(no_rotations));
        losses
    }

    /// Whether anything of the file was lost.
    #[must_use]
    pub fn has_loss(&self) -> bool {
        self.rows_rejected + self.rows_repeating_a_time + self.invalid_attitudes > 0
    }
}
