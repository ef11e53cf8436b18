//! Parts of the program that a test stops, to see that the vehicle is then left to its own failsafe.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

use super::clock::utc_us;

/// How a part stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// it stands still, and holds what it has
    Stands,
    /// it panics
    Panics,
    /// it ends, and all that it has is dropped
    Ends,
}

/// Ends a part by a panic, as a fault in it would.
///
/// # Panics
/// Always: a test asked for it.
#[expect(
    clippy::panic,
    reason = "that a panic does no harm is what the test is for; nothing but a test asks for one"
)]
pub fn panic_for_test(part: &'static str) -> ! {
    std::panic::panic_any(part)
}

/// Where a part of the program is stopped, and when it last ran. By itself it never stops. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct Halt(Arc<State>);

#[derive(Debug, Default)]
struct State {
    stop: AtomicU8,
    ran_us: AtomicU64,
}

impl Halt {
    /// Lets the part stop, from its next look on.
    pub fn stop(&self, how: Stop) {
        let code = match how {
            Stop::Stands => 1,
            Stop::Panics => 2,
            Stop::Ends => 3,
        };
        self.0.stop.store(code, Ordering::Release);
    }

    /// Lets it continue; one that is gone stays gone.
    pub fn release(&self) {
        self.0.stop.store(0, Ordering::Release);
    }

    /// How it is to stop, for the part itself.
    #[must_use]
    pub fn stopped(&self) -> Option<Stop> {
        match self.0.stop.load(Ordering::Acquire) {
            1 => Some(Stop::Stands),
            2 => Some(Stop::Panics),
            3 => Some(Stop::Ends),
            _ => None,
        }
    }

    /// The part has just done what it is there for.
    pub fn runs(&self) {
        self.0.ran_us.store(utc_us(), Ordering::Release);
    }

    /// When it last did, us since 1970, UTC; 0 before the first time.
    #[must_use]
    pub fn last_ran_us(&self) -> u64 {
        self.0.ran_us.load(Ordering::Acquire)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_stops_as_it_is_told() {
        let halt = Halt::default();
        assert_eq!((halt.stopped(), halt.last_ran_us()), (None, 0));
        for how in [Stop::Stands, Stop::Panics, Stop::Ends] {
            halt.clone().stop(how);
            assert_eq!(halt.stopped(), Some(how));
        }
        halt.release();
        halt.runs();
        assert!(halt.stopped().is_none() && halt.last_ran_us() > 0);
    }
}
