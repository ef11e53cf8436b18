//! When a log began, by what a satellite receiver says of the time.

use crate::units::{seconds_from_us, whole_unsigned};

/// Begin of the satellites' weeks, s since 1970 UTC.
const GPS_EPOCH_S: f64 = 315_964_800.0;
/// s of a week.
const WEEK_S: f64 = 604_800.0;
/// Satellites count no leap seconds: so many since 2017, two fewer five years before. The order of flights does not depend on them.
const LEAP_S: f64 = 18.0;
/// Times of receivers, s since 1970 UTC: from 2005 to 2100. What is outside of it was said before satellites were seen.
const POSSIBLE_S: std::ops::Range<f64> = 1.1e9..4.1e9;
/// Two words on the beginning agree within this, s. Damage and a receiver that is not sure yet do not.
const AGREES_S: f64 = 2.0;

/// When a log began: what two words in a row agree on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Date {
    began_s: Option<f64>,
    doubted_s: Option<f64>,
}

impl Date {
    /// Nothing more needs to be said.
    #[inline]
    pub(super) fn is_known(&self) -> bool {
        self.began_s.is_some()
    }

    /// A receiver's time, microseconds since 1970 UTC, at `time_s` of the recording's clock.
    pub(super) fn utc_us(&mut self, utc_us: f64, time_s: f64) {
        self.utc_s(seconds_from_us(utc_us), time_s);
    }

    /// A receiver's week, and ms of it.
    pub(super) fn satellites(&mut self, week: f64, of_week_ms: f64, time_s: f64) {
        self.utc_s(GPS_EPOCH_S + week * WEEK_S + 1e-3 * of_week_ms - LEAP_S, time_s);
    }

    fn utc_s(&mut self, utc_s: f64, time_s: f64) {
        if self.is_known() || !POSSIBLE_S.contains(&utc_s) || !time_s.is_finite() {
            return;
        }
        let began_s = utc_s - time_s;
        let agrees = |other: f64| (other - began_s).abs() < AGREES_S;
        if self.doubted_s.replace(began_s).is_some_and(agrees) {
            self.began_s = Some(began_s);
        }
    }

    /// Microseconds since 1970 UTC at which the recording's clock is zero.
    pub(super) fn began_us(&self) -> Option<u64> {
        self.began_s.map(|began_s| u64::from(whole_unsigned(began_s)) * 1_000_000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_words_that_agree_tell_when_a_log_began() {
        let mut date = Date::default();
        date.utc_us(0.0, 1.0);
        date.utc_us(1_647_250_000e6, 2.0);
        // damage
        date.utc_us(3_000_000_000e6, 2.2);
        assert_eq!(date.began_us(), None);
        date.utc_us(1_647_250_000e6, 4.0);
        date.utc_us(1_647_250_001e6, 5.0);
        assert_eq!(date.began_us(), Some(1_647_249_996_000_000));
        // 2022-03-14 is in week 2201 of the satellites
        let mut date = Date::default();
        date.satellites(2201.0, 121_218_000.0, 0.0);
        date.satellites(2201.0, 121_219_000.0, 1.0);
        assert_eq!(date.began_us(), Some(1_647_250_800_000_000));
    }
}
