//! How long to wait before the next try.

use std::time::Duration;

const FIRST: Duration = Duration::from_millis(100);
const LONGEST: Duration = Duration::from_secs(3);

/// Waits longer each time, until told that it worked.
#[derive(Debug)]
pub(super) struct Backoff {
    next: Duration,
}

impl Backoff {
    pub fn new() -> Self {
        Self { next: FIRST }
    }

    /// Waits; the next wait is twice as long, up to a bound.
    pub async fn wait(&mut self) {
        tokio::time::sleep(self.next).await;
        self.next = LONGEST.min(2 * self.next);
    }

    /// It worked: the next wait is short again.
    pub fn reset(&mut self) {
        self.next = FIRST;
    }
}
