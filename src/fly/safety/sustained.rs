//! For how long a condition has held.

use std::time::Duration;

/// How long a condition has held without a break.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sustained {
    since: Option<Duration>,
}

impl Sustained {
    /// Takes the condition of now; gives for how long it holds.
    pub fn update(&mut self, now: Duration, holds: bool) -> Duration {
        if !holds {
            self.since = None;
            return Duration::ZERO;
        }
        now.saturating_sub(*self.since.get_or_insert(now))
    }
}
