//! Parts of the program that a test stops, to see that the vehicle is then left to its own failsafe, and sleep of the
//! whole computer.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::link::{Halt, Stop};

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

/// What is stopped; nothing by itself. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Parking {
    supervisor: Halt,
    telemetry: Halt,
    link: Halt,
    slept_ms: Arc<AtomicU64>,
}

impl Parking {
    /// Lets a part stop from now on.
    pub fn stop(&self, part: Part, how: Stop) {
        self.halt(part).stop(how);
    }

    /// Lets all parts that stand still continue.
    pub fn release(&self) {
        for part in [Part::Supervisor, Part::Telemetry, Part::Link] {
            self.halt(part).release();
        }
    }

    /// When a part last did what it is there for, us since 1970, UTC. The telemetry does so as well while nothing of the
    /// link waits for it.
    #[must_use]
    pub fn last_ran_us(&self, part: Part) -> u64 {
        self.halt(part).last_ran_us()
    }

    /// The computer sleeps for so long: the clock of the flight leaps, and nothing else does.
    pub fn sleep(&self, lasts: Duration) {
        self.slept_ms.fetch_add(u64::try_from(lasts.as_millis()).unwrap_or(u64::MAX), Ordering::AcqRel);
    }

    pub(super) fn slept(&self) -> Duration {
        Duration::from_millis(self.slept_ms.load(Ordering::Acquire))
    }

    pub(super) fn halt(&self, part: Part) -> &Halt {
        match part {
            Part::Supervisor => &self.supervisor,
            Part::Telemetry => &self.telemetry,
            Part::Link => &self.link,
        }
    }
}
