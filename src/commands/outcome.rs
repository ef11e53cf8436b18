//! The outcome of a verb that did not fail.

use std::process::ExitCode;

/// Exit status of what was done with a loss, and of what a signal ended before it was done.
pub const NOT_ALL: u8 = 3;

/// How a verb ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// all of it
    Done,
    /// done, but something was lost or left out; the output says what
    DoneWithLoss,
    /// done: what was compared is not the same
    Changed,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Done => Self::SUCCESS,
            Outcome::DoneWithLoss => Self::from(NOT_ALL),
            Outcome::Changed => Self::from(4),
        }
    }
}
