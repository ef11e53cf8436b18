//! Parts of the program that a test lets stand still, to see that the vehicle is then left to its own failsafe, and sleep
//! of the whole computer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// A part of the program without which nobody may steer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// the state machine of the flight, which renews what is to be sent
    Supervisor,
    /// the way of frames from the link to the supervisor
    Telemetry,
    /// the task that reads and writes the link
    Link,
}

/// What stands still; nothing by itself. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Parking {
    supervisor: Arc<AtomicBool>,
    telemetry: Arc<AtomicBool>,
    link: Arc<AtomicBool>,
    slept_ms: Arc<AtomicU64>,
}

impl Parking {
    /// Lets a part stand still from now on.
    pub fn park(&self, part: Part) {
        self.flag(part).store(true, Ordering::Release);
    }

    /// Lets all parts go on.
    pub fn release(&self) {
        for part in [Part::Supervisor, Part::Telemetry, Part::Link] {
            self.flag(part).store(false, Ordering::Release);
        }
    }

    /// The computer sleeps for so long: the clock of the flight leaps, and nothing else does.
    pub fn sleep(&self, lasts: Duration) {
        self.slept_ms.fetch_add(u64::try_from(lasts.as_millis()).unwrap_or(u64::MAX), Ordering::AcqRel);
    }

    pub(super) fn slept(&self) -> Duration {
        Duration::from_millis(self.slept_ms.load(Ordering::Acquire))
    }

    pub(super) fn is_parked(&self, part: Part) -> bool {
        self.flag(part).load(Ordering::Acquire)
    }

    pub(super) fn flag(&self, part: Part) -> &Arc<AtomicBool> {
        match part {
            Part::Supervisor => &self.supervisor,
            Part::Telemetry => &self.telemetry,
            Part::Link => &self.link,
        }
    }
}
