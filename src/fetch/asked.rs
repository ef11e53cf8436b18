//! One request: when it is due again, and when enough is enough.

use std::time::Duration;

use super::FetchError;
use super::pace::Pace;

/// Times that one thing is asked for, at most. Over a link that loses a fifth both ways all of them get lost once in
/// a hundred thousand times.
const TRIES: u32 = 12;

/// One request.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Asked {
    tries: u32,
    first: Option<Duration>,
    last: Option<Duration>,
}

impl Asked {
    /// Never sent, or not answered for as long as answers take.
    pub(super) fn is_due(&self, now: Duration, pace: &Pace) -> bool {
        self.is_due_after(now, pace.answer(self.tries.saturating_sub(1)))
    }

    /// Never sent, or not within this time.
    pub(super) fn is_due_after(&self, now: Duration, patience: Duration) -> bool {
        self.last.is_none_or(|last| now.saturating_sub(last) >= patience)
    }

    /// It is sent now.
    ///
    /// # Errors
    /// It was sent often enough.
    pub(super) fn send(&mut self, now: Duration, expected: &str) -> Result<(), FetchError> {
        self.send_at_most(TRIES, now, expected)
    }

    /// The same with another limit.
    pub(super) fn send_at_most(
        &mut self,
        most: u32,
        now: Duration,
        expected: &str,
    ) -> Result<(), FetchError> {
        let first = *self.first.get_or_insert(now);
        if self.tries >= most {
            let seconds = now.saturating_sub(first).as_secs();
            return Err(FetchError::Silent { expected: expected.to_owned(), tries: self.tries, seconds });
        }
        self.tries += 1;
        self.last = Some(now);
        Ok(())
    }

    /// Its answer is there. What was asked twice tells nothing of the link: either may have been answered.
    pub(super) fn answered(&self, now: Duration, pace: &mut Pace) {
        if let (1, Some(last)) = (self.tries, self.last) {
            pace.answered(now.saturating_sub(last));
        }
    }

    /// How often it was sent.
    pub(super) fn tries(&self) -> u32 {
        self.tries
    }
}
