//! What of a log could not be read.

use crate::log::loss::{Loss, RowRejection};

/// What of a log could not be read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DataflashDamage {
    /// bytes read
    pub bytes: u64,
    /// messages read, definitions included
    pub messages: u64,
    /// bytes that are no part of a message
    pub skipped_bytes: u64,
    /// stretches of them
    pub skips: u64,
    /// byte offset of the first
    pub first_skip: Option<u64>,
    /// bytes at the end: a message cut off, or what an empty memory holds
    pub tail_bytes: u64,
    /// lines of a text log whose cells do not fit their definition
    pub lines_rejected: u64,
    /// the first of them
    pub first_rejection: Option<RowRejection>,
    /// lines of a text log that begin with no name that it defines
    pub lines_unknown: u64,
}

impl DataflashDamage {
    pub(super) fn skip(&mut self, offset: u64, bytes: u64) {
        self.skips += 1;
        self.skipped_bytes += bytes;
        self.first_skip.get_or_insert(offset);
    }

    /// What is gone.
    #[must_use]
    pub fn losses(&self) -> Vec<Loss> {
        let skipped = Loss::Skipped {
            unit: "message",
            bytes: self.skipped_bytes,
            places: self.skips,
            first_byte: self.first_skip.unwrap_or(0),
        };
        let tail = self.tail_bytes;
        let cut_off = Loss::CutOff { bytes: tail, first_byte: self.bytes.saturating_sub(tail) };
        let rejected = Loss::RowsRejected {
            count: self.lines_rejected,
            of: self.messages + self.lines_rejected,
            first: self.first_rejection.clone(),
        };
        [(self.skips, skipped), (tail, cut_off), (self.lines_rejected, rejected)]
            .into_iter()
            .filter_map(|(count, loss)| (count > 0).then_some(loss))
            .collect()
    }
}
