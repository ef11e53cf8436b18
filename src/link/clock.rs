//! The host's time: a monotonic clock, tied to UTC once.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use tokio::time::Instant;

/// A monotonic clock tied to UTC when it was started: its stamps never go backwards, whatever a time server
/// does to the wall clock meanwhile.
#[derive(Debug, Clone, Copy)]
pub struct HostClock {
    start: Instant,
    start_us: u64,
}

/// A moment of the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct HostStamp {
    /// on the monotonic clock
    pub at: Instant,
    /// microseconds since 1970 UTC
    pub utc_us: u64,
}

impl HostClock {
    /// A clock tied to UTC now.
    #[must_use]
    pub fn start() -> Self {
        Self { start: Instant::now(), start_us: utc_us() }
    }

    /// The present moment.
    #[must_use]
    pub fn now(&self) -> HostStamp {
        self.stamp(Instant::now())
    }

    /// A moment of the monotonic clock; one before the start counts as the start.
    #[must_use]
    pub fn stamp(&self, at: Instant) -> HostStamp {
        HostStamp {
            at,
            utc_us: self.start_us.saturating_add(micros(at.saturating_duration_since(self.start))),
        }
    }
}

impl Default for HostClock {
    fn default() -> Self {
        Self::start()
    }
}

/// The wall clock, microseconds since 1970 UTC; 0 for a clock set before that.
pub(super) fn utc_us() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, micros)
}

fn micros(duration: Duration) -> u64 {
    u64::try_from(duration.as_micros()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn stamps_follow_the_monotonic_clock_alone() {
        let clock = HostClock::start();
        let first = clock.now();
        tokio::time::advance(Duration::from_millis(1500)).await;
        assert_eq!(clock.now().utc_us - first.utc_us, 1_500_000);
        assert_eq!(clock.stamp(first.at - Duration::from_secs(9)).utc_us, clock.start_us);
    }
}
