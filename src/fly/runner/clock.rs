//! The clock of a flight. It continues while the computer sleeps, so that a sleep is a stall like any other.

use std::time::Duration;

use super::parking::Parking;

/// Time since a flight began.
#[derive(Debug, Clone)]
pub(super) struct Clock {
    start: Moment,
    parking: Parking,
}

impl Clock {
    /// A clock that begins now. A test lets it leap by its `parking`.
    pub(super) fn start(parking: Parking) -> Self {
        Self { start: Moment::now(), parking }
    }

    /// Since it began, the time for which the computer slept included.
    pub(super) fn elapsed(&self) -> Duration {
        self.start.elapsed() + self.parking.slept()
    }
}

#[cfg(unix)]
#[derive(Debug, Clone, Copy)]
struct Moment(Duration);

#[cfg(unix)]
impl Moment {
    /// `Instant` uses a clock that stops while the computer sleeps: CLOCK_MONOTONIC on Linux, CLOCK_UPTIME_RAW at
    /// Apple's, whose CLOCK_MONOTONIC continues.
    #[cfg(any(target_os = "linux", target_os = "android"))]
    const ID: rustix::time::ClockId = rustix::time::ClockId::Boottime;
    #[cfg(not(any(target_os = "linux", target_os = "android")))]
    const ID: rustix::time::ClockId = rustix::time::ClockId::Monotonic;

    fn now() -> Self {
        let time = rustix::time::clock_gettime(Self::ID);
        let seconds = u64::try_from(time.tv_sec).unwrap_or(0);
        Self(Duration::new(seconds, u32::try_from(time.tv_nsec).unwrap_or(0)))
    }

    fn elapsed(self) -> Duration {
        Self::now().0.saturating_sub(self.0)
    }
}

/// On other systems, the system's own clock; on Windows it continues in a sleep.
#[cfg(not(unix))]
#[derive(Debug, Clone, Copy)]
struct Moment(std::time::Instant);

#[cfg(not(unix))]
impl Moment {
    fn now() -> Self {
        Self(std::time::Instant::now())
    }

    fn elapsed(self) -> Duration {
        self.0.elapsed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sleep_counts() {
        let parking = Parking::default();
        let clock = Clock::start(parking.clone());
        let before = clock.elapsed();
        parking.sleep(Duration::from_secs(600));
        let after = clock.elapsed();
        assert!(after - before >= Duration::from_secs(600), "{before:?} {after:?}");
    }

    /// While the computer is awake, both clocks of Linux go alike.
    #[cfg(target_os = "linux")]
    #[test]
    fn it_is_the_clock_that_counts_sleep() {
        let read = |id| {
            let time = rustix::time::clock_gettime(id);
            Duration::new(u64::try_from(time.tv_sec).unwrap(), u32::try_from(time.tv_nsec).unwrap())
        };
        let before = read(rustix::time::ClockId::Boottime);
        let now = Moment::now().0;
        assert!(before <= now && now <= read(rustix::time::ClockId::Boottime));
    }
}
