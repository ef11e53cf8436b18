//! Puts every sample on the vehicle's clock.
//!
//! A log's stamps are microseconds since the vehicle started, or of a wall clock; zero is the log's own beginning. Damage
//! can hide in a stamp, and several logs may stand behind each other in one file, each with a clock of its own.

use crate::units::seconds_from_us;
use crate::wire::{BACKWARD_US, WITNESSES};

/// What follows tells a longer leap forward from damage.
const FORWARD_US: u64 = 2_000_000;
/// Stamps behind one another agree within this.
const AGREES_US: u64 = 2_000_000;
/// So many stamps in a row that fit and are far behind the latest one: damage put that ahead.
const BEHIND: u8 = 64;
/// Time goes on by this much where the clock started anew: how long that took is not known.
const RESTART_US: i128 = 1_000_000;

/// Where a message falls on the recording's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Placed {
    /// at [`Clock::seconds`] of its stamp
    At,
    /// the same, and the vehicle's clock started anew
    Restarted,
    /// its stamp fits neither the clock nor a new one (so far): drop the message
    Stale,
    /// its stamp leaps ahead: [`Clock::leap`] where time passed
    Leaps,
}

/// The recording's clock.
#[derive(Debug, Clone, Default)]
pub(super) struct Clock {
    /// stamp at which the recording's time is zero; below zero after a restart
    zero_us: i128,
    /// the latest stamp that fitted, or the log's beginning
    last_us: u64,
    /// a stamp has fitted
    runs: bool,
    /// stamps in a row that fit and are far behind the latest
    behind: u8,
    suspect_us: u64,
    suspects: u8,
    /// times that stamps ran back for good, though no other log began
    pub ran_back: u64,
    /// the furthest of these, microseconds
    pub ran_back_most_us: u64,
}

impl Clock {
    /// A log begins; `true` where it is not the first: the clock started anew.
    pub(super) fn begin(&mut self, start_us: u64) -> bool {
        if self.runs {
            self.restart(start_us);
            return true;
        }
        (self.zero_us, self.last_us) = (start_us.into(), start_us);
        false
    }

    /// Recording time of a stamp, s.
    #[inline]
    pub(super) fn seconds(&self, stamp_us: u64) -> f64 {
        let since_us = i128::from(stamp_us) - self.zero_us;
        seconds_from_us(match i64::try_from(since_us) {
            // 64 bits become a number in one instruction
            Ok(us) => us as f64,
            Err(_) => far(since_us),
        })
    }

    /// Whether a stamp of a topic's message goes on from the last ones; `before_us` is that of the topic's last one. A topic's
    /// first message may be old: it was true before the log began.
    #[inline]
    pub(super) fn goes_on(&self, stamp_us: u64, before_us: Option<u64>) -> bool {
        match before_us {
            None if stamp_us <= self.last_us => true,
            Some(before_us) if before_us.saturating_sub(stamp_us) > BACKWARD_US.unsigned_abs() => false,
            _ => !self.is_ahead(stamp_us),
        }
    }

    fn is_ahead(&self, stamp_us: u64) -> bool {
        self.runs && stamp_us.saturating_sub(self.last_us) > FORWARD_US
    }

    /// Takes a stamp that goes on from the last ones.
    #[inline]
    pub(super) fn go_on(&mut self, stamp_us: u64) {
        let is_behind = stamp_us.saturating_add(BACKWARD_US.unsigned_abs()) < self.last_us;
        self.behind = if is_behind { self.behind + 1 } else { 0 };
        if self.behind >= BEHIND {
            (self.last_us, self.behind) = (stamp_us, 0);
        }
        self.last_us = self.last_us.max(stamp_us);
        self.runs = true;
        self.suspects = 0;
    }

    /// Takes the stamp of a topic's message; `before_us` is that of its last one.
    pub(super) fn place(&mut self, stamp_us: u64, before_us: Option<u64>) -> Placed {
        if self.goes_on(stamp_us, before_us) {
            self.go_on(stamp_us);
            Placed::At
        } else if self.is_ahead(stamp_us) {
            Placed::Leaps
        } else {
            self.suspect(stamp_us)
        }
    }

    /// The latest stamp, s.
    pub(super) fn last_s(&self) -> f64 {
        seconds_from_us(self.last_us as f64)
    }

    /// Time passed up to a stamp that leaps.
    pub(super) fn leap(&mut self, stamp_us: u64) {
        self.last_us = self.last_us.max(stamp_us);
        self.suspects = 0;
    }

    fn suspect(&mut self, stamp_us: u64) -> Placed {
        let agrees = self.suspects > 0 && stamp_us.abs_diff(self.suspect_us) < AGREES_US;
        self.suspects = if agrees { self.suspects + 1 } else { 1 };
        self.suspect_us = stamp_us;
        if self.suspects < WITNESSES {
            return Placed::Stale;
        }
        self.suspects = 0;
        self.ran_back += 1;
        self.ran_back_most_us = self.ran_back_most_us.max(self.last_us.saturating_sub(stamp_us));
        self.restart(stamp_us);
        Placed::Restarted
    }

    /// Time goes on from the last stamp of the old clock to the first of the new one.
    fn restart(&mut self, first_us: u64) {
        let last_time_us = i128::from(self.last_us) - self.zero_us;
        self.zero_us = i128::from(first_us) - last_time_us - RESTART_US;
        self.last_us = first_us;
    }
}

#[cold]
#[inline(never)]
fn far(us: i128) -> f64 {
    us as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_is_the_logs_beginning_and_older_news_is_before_it() {
        let mut clock = Clock::default();
        assert!(!clock.begin(5_000_000));
        assert_eq!(clock.place(5_100_000, None), Placed::At);
        assert_eq!(clock.place(1_000_000, None), Placed::At);
        assert!((clock.seconds(5_100_000) - 0.1).abs() < 1e-9);
        assert!((clock.seconds(1_000_000) + 4.0).abs() < 1e-9);
    }

    #[test]
    fn a_single_stamp_that_fits_nothing_is_dropped() {
        let mut clock = Clock::default();
        clock.begin(0);
        assert_eq!(clock.place(10_000_000, None), Placed::At);
        for (odd, placed) in [(0, Placed::Stale), (5_000_000, Placed::Stale), (u64::MAX, Placed::Leaps)] {
            assert_eq!(clock.place(odd, Some(10_000_000)), placed, "{odd}");
            assert_eq!(clock.place(10_010_000, Some(10_000_000)), Placed::At);
        }
    }

    #[test]
    fn stamps_that_damage_puts_ahead_bit_by_bit_do_not_move_the_clock_for_long() {
        let mut clock = Clock::default();
        clock.begin(0);
        for stamp_us in [1_000_000, 2_900_000, 4_800_000] {
            assert_eq!(clock.place(stamp_us, None), Placed::At);
        }
        for order in 0..u64::from(BEHIND) {
            assert_eq!(clock.place(1_010_000 + 100 * order, Some(1_000_000)), Placed::At);
        }
        assert!((clock.last_s() - 1.0163).abs() < 1e-9);
    }

    #[test]
    fn a_clock_that_starts_anew_goes_on_in_time() {
        let mut clock = Clock::default();
        clock.begin(100_000_000);
        clock.place(160_000_000, None);
        let placed = [1_000_000, 1_004_000, 1_008_000].map(|us| clock.place(us, Some(160_000_000)));
        assert_eq!(placed, [Placed::Stale, Placed::Stale, Placed::Restarted]);
        assert_eq!((clock.ran_back, clock.ran_back_most_us), (1, 159_000_000 - 8_000));
        assert!((clock.seconds(1_008_000) - 61.0).abs() < 1e-9);
        assert!(clock.begin(0));
        assert!((clock.seconds(0) - 62.0).abs() < 1e-9);
    }

    #[test]
    fn a_leap_counts_once_it_is_known_to_be_time_that_passed() {
        let mut clock = Clock::default();
        clock.begin(0);
        clock.place(1_000_000, None);
        assert_eq!(clock.place(200_000_000, Some(1_000_000)), Placed::Leaps);
        assert!((clock.last_s() - 1.0).abs() < 1e-9);
        clock.leap(200_000_000);
        assert_eq!(clock.place(200_000_000, Some(1_000_000)), Placed::At);
        assert!((clock.seconds(200_000_200) - 200.0002).abs() < 1e-9);
    }
}
