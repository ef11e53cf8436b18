//! The vehicle's clock: stamps become times since the log's first.

/// A stamp this much before the last one, s, is of another clock, or of no clock. Messages of several threads run back by
/// less.
const BACK_S: f64 = 10.0;
/// A stamp this much after the last one, s, needs a second one that agrees: damage hides in stamps. The first one is not read, so
/// that pauses of a log are let pass.
const LEAP_S: f64 = 3600.0;
/// A stamp this much after the last one, s, is damaged, whatever agrees with it: no log lasts for a month.
const NEVER_S: f64 = 2.7e6;
/// A leap this long, s, that the next stamp takes back was damage.
const DOUBTFUL_S: f64 = 10.0;
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
    /// the last stamp before a leap, s, until another has followed it
    before_leap_s: Option<f64>,
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
        let follows = |last_s: f64| (-BACK_S..LEAP_S).contains(&(stamp_s - last_s));
        let agrees = |doubted_s: f64| (stamp_s - doubted_s).abs() < AGREES_S;
        if std::mem::take(&mut self.may_restart) && stamp_s < self.last_s {
            let time_s = self.latest_s - zero_s + PAUSE_S;
            self.zero_s = Some(stamp_s - time_s);
            (self.last_s, self.latest_s, self.doubted_s) = (stamp_s, stamp_s, None);
            return Placed::Anew(time_s);
        }
        let taken_back = |before_s: &f64| (-BACK_S..DOUBTFUL_S).contains(&(stamp_s - before_s));
        let mut before_leap_s = (stamp_s - self.last_s > DOUBTFUL_S).then_some(self.last_s);
        if self.before_leap_s.take().as_ref().is_some_and(taken_back) {
            self.strays += 1;
            self.latest_s = stamp_s;
        } else if !follows(self.last_s) {
            if stamp_s - self.last_s > NEVER_S || !self.doubted_s.is_some_and(agrees) {
                self.doubted_s = Some(stamp_s);
                self.strays += 1;
                return Placed::Stray;
            }
            // the first of both is not read, and was right
            self.strays -= 1;
            before_leap_s = None;
            if stamp_s < self.last_s {
                self.ran_back += 1;
                self.ran_back_most_s = self.ran_back_most_s.max(self.last_s - stamp_s);
            }
        }
        self.doubted_s = None;
        self.before_leap_s = before_leap_s;
        self.last_s = stamp_s;
        self.latest_s = self.latest_s.max(stamp_s);
        Placed::At(stamp_s - zero_s)
    }
}

#[cfg(test)]
mod tests {
    use super::{Clock, Placed};

    #[test]
    fn one_wrong_stamp_is_a_stray_and_two_that_agree_are_a_leap() {
        let mut clock = Clock::default();
        assert_eq!(clock.place(40.0), Placed::At(0.0));
        assert_eq!(clock.place(41.0), Placed::At(1.0));
        assert_eq!(clock.place(9e9), Placed::Stray);
        assert_eq!(clock.place(41.5), Placed::At(1.5));
        // threads
        assert_eq!(clock.place(41.25), Placed::At(1.25));
        assert_eq!([clock.place(9000.0), clock.place(9001.0)], [Placed::Stray, Placed::At(8961.0)]);
        assert_eq!((clock.strays, clock.ran_back), (1, 0));
        assert_eq!([clock.place(50.0), clock.place(51.0)], [Placed::Stray, Placed::At(11.0)]);
        assert_eq!((clock.strays, clock.ran_back), (1, 1));
        // one that is wrong by less than an hour is read, and the next one takes it back
        assert_eq!([clock.place(900.0), clock.place(51.25)], [Placed::At(860.0), Placed::At(11.25)]);
        assert_eq!((clock.strays, clock.ran_back), (2, 1));
        // two wrong ones that do not agree
        assert_eq!([clock.place(9000.0), clock.place(20_000.0)], [Placed::Stray; 2]);
        assert_eq!(clock.place(51.5), Placed::At(11.5));
        assert_eq!((clock.strays, clock.ran_back), (4, 1));
        // two wrong ones that agree, years ahead
        assert_eq!(
            [clock.place(9e9), clock.place(9e9 + 0.1), clock.place(52.0)],
            [Placed::Stray, Placed::Stray, Placed::At(12.0)]
        );
    }

    #[test]
    fn a_second_log_behind_the_first_begins_after_it() {
        let mut clock = Clock::default();
        clock.definitions_anew();
        assert_eq!([clock.place(40.0), clock.place(60.0)], [Placed::At(0.0), Placed::At(20.0)]);
        clock.definitions_anew();
        assert_eq!([clock.place(3.0), clock.place(4.0)], [Placed::Anew(21.0), Placed::At(22.0)]);
        assert_eq!(clock.beside(4.1), Some(22.1));
        assert_eq!(clock.beside(400.0), None);
    }
}
