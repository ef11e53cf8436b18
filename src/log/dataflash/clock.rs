//! The vehicle's clock: stamps become times since the log's first.

/// A stamp this much before the last one, s, is of another clock, or of no clock. Messages of several threads run back by
/// less.
const BACK_S: f64 = 10.0;
/// A stamp this much after the last one, s, leaps: what follows tells time that passed from damage.
const LEAP_S: f64 = 10.0;
/// A stamp this much after the last one, s, is damaged, whatever agrees with it: no log lasts for a month.
const NEVER_S: f64 = 2.7e6;
/// Two stamps behind one another agree within this, s.
const AGREES_S: f64 = 2.0;
/// Between two logs of which one stands behind the other, s: the pause itself is not known.
const PAUSE_S: f64 = 1.0;

/// Where a stamp is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Placed {
    /// s since the log's first stamp
    At(f64),
    /// the same, of a clock that began anew
    Anew(f64),
    /// fits no clock
    Stray,
    /// far ahead: [`Clock::leap`] where time passed, [`Clock::damaged`] where it did not
    Leaps,
}

/// The vehicle's clock.
#[derive(Debug, Default)]
pub(super) struct Clock {
    /// what is taken from a stamp, s
    zero_s: Option<f64>,
    last_s: f64,
    latest_s: f64,
    /// a stamp far from the last one, until another agrees with it
    doubted_s: Option<f64>,
    /// definitions began anew: so may the clock
    may_restart: bool,
    /// stamps that fit no clock
    pub strays: u64,
    /// times that stamps ran back for good, though no clock began anew
    pub ran_back: u64,
    /// the furthest of these, s
    ran_back_most_s: f64,
}

impl Clock {
    /// The log's definitions begin anew: what follows may be another log.
    pub(super) fn definitions_anew(&mut self) {
        self.may_restart = self.zero_s.is_some();
    }

    /// The time of the last stamp, s.
    pub(super) fn now_s(&self) -> f64 {
        self.zero_s.map_or(0.0, |zero_s| self.last_s - zero_s)
    }

    /// The time of another stamp of the same message, s; `None` where it is far from the message's own.
    pub(super) fn beside(&self, stamp_s: f64) -> Option<f64> {
        let zero_s = self.zero_s?;
        ((stamp_s - self.last_s).abs() < BACK_S).then_some(stamp_s - zero_s)
    }

    /// The furthest that stamps ran back for good, microseconds.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it saturates")]
    pub(super) fn ran_back_most_us(&self) -> u64 {
        (self.ran_back_most_s * 1e6) as u64
    }

    /// Places a message's stamp, s.
    pub(super) fn place(&mut self, stamp_s: f64) -> Placed {
        let Some(zero_s) = self.zero_s else {
            self.zero_s = Some(stamp_s);
            (self.last_s, self.latest_s) = (stamp_s, stamp_s);
            return Placed::At(0.0);
        };
        if std::mem::take(&mut self.may_restart) && stamp_s < self.last_s {
            let time_s = self.latest_s - zero_s + PAUSE_S;
            self.zero_s = Some(stamp_s - time_s);
            (self.last_s, self.latest_s, self.doubted_s) = (stamp_s, stamp_s, None);
            return Placed::Anew(time_s);
        }
        let since_s = stamp_s - self.last_s;
        if since_s > NEVER_S {
            self.strays += 1;
            return Placed::Stray;
        }
        if since_s > LEAP_S {
            return Placed::Leaps;
        }
        if since_s < -BACK_S {
            let agrees = |doubted_s: f64| (stamp_s - doubted_s).abs() < AGREES_S;
            if !self.doubted_s.is_some_and(agrees) {
                self.doubted_s = Some(stamp_s);
                self.strays += 1;
                return Placed::Stray;
            }
            // the first of both is not read, and was right
            self.strays -= 1;
            self.ran_back += 1;
            self.ran_back_most_s = self.ran_back_most_s.max(-since_s);
        }
        self.go_on(stamp_s);
        Placed::At(stamp_s - zero_s)
    }

    /// The last stamp, s.
    pub(super) fn last_s(&self) -> f64 {
        self.last_s
    }

    /// Time passed up to a stamp that leaps, s.
    pub(super) fn leap(&mut self, stamp_s: f64) {
        self.go_on(stamp_s);
    }

    /// So many stamps that leapt were damaged.
    pub(super) fn damaged(&mut self, count: u64) {
        self.strays += count;
    }

    fn go_on(&mut self, stamp_s: f64) {
        self.doubted_s = None;
        self.last_s = stamp_s;
        self.latest_s = self.latest_s.max(stamp_s);
    }
}

#[cfg(test)]
mod tests {
    use super::{Clock, Placed};

    #[test]
    fn a_wrong_stamp_is_a_stray_and_a_leap_waits() {
        let mut clock = Clock::default();
        assert_eq!(clock.place(40.0), Placed::At(0.0));
        assert_eq!(clock.place(41.0), Placed::At(1.0));
        // years ahead, whatever agrees with it
        assert_eq!([clock.place(9e9), clock.place(9e9 + 0.1)], [Placed::Stray; 2]);
        // threads
        assert_eq!([clock.place(41.5), clock.place(41.25)], [Placed::At(1.5), Placed::At(1.25)]);
        assert_eq!((clock.strays, clock.ran_back), (2, 0));
        assert_eq!([clock.place(900.0), clock.place(42.0)], [Placed::Leaps, Placed::At(2.0)]);
        clock.damaged(1);
        assert_eq!(clock.place(9000.0), Placed::Leaps);
        clock.leap(9000.0);
        assert_eq!(clock.place(9000.0), Placed::At(8960.0));
        assert_eq!([clock.place(50.0), clock.place(51.0)], [Placed::Stray, Placed::At(11.0)]);
        assert_eq!((clock.strays, clock.ran_back), (3, 1));
    }

    #[test]
    fn a_second_log_behind_the_first_begins_after_it() {
        let mut clock = Clock::default();
        clock.definitions_anew();
        assert_eq!([clock.place(40.0), clock.place(48.0)], [Placed::At(0.0), Placed::At(8.0)]);
        clock.definitions_anew();
        assert_eq!([clock.place(3.0), clock.place(4.0)], [Placed::Anew(9.0), Placed::At(10.0)]);
        assert_eq!(clock.beside(4.1), Some(10.1));
        assert_eq!(clock.beside(400.0), None);
    }
}
