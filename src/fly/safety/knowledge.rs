//! Whether the vehicle's mode is known well enough to command it.
//!
//! A report of the mode that was read counts. After a stall of this program or a silence of the vehicle no report
//! counts at first: what is read then may have been sent long ago. The vehicle is asked, and a report counts again
//! once the vehicle has answered a question that was sent after the stall or the silence. The questions are numbered
//! (TIMESYNC gives the number back), so that an older answer is not taken for the newer one's.

use std::time::Duration;

/// Between two questions.
const ASK_AGAIN: Duration = Duration::from_millis(200);
/// A vehicle that reports its mode and answers no question is believed after this time: whatever lay in a socket when this
/// program woke, or in a radio when the vehicle was heard again, is read by then.
const SOCKET_IS_READ: Duration = Duration::from_millis(500);
const RADIO_IS_READ: Duration = Duration::from_millis(1500);
/// After a shorter standstill commands wait for a report, and setpoints do not.
const SHORT: Duration = Duration::from_millis(300);

/// Why the mode is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doubted {
    /// this program stood still for so long
    Stall(Duration),
    /// the vehicle was not heard
    Silence,
    /// another mode was reported by a frame that was sent before the last report, as far as sequence numbers tell
    Contradiction,
}

/// What makes the mode uncertain, and what was done about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Doubt {
    since: Duration,
    why: Doubted,
    /// number of the first question that went out since
    asked: Option<i64>,
    answered: bool,
}

/// How many reports of the mode count so far, and whether those that come now do.
#[derive(Debug, Clone, Default)]
pub struct ModeKnowledge {
    reports: u64,
    doubt: Option<Doubt>,
    asked: Option<Duration>,
}

impl ModeKnowledge {
    /// From now on the mode is not known: this program stood still, or the vehicle was silent.
    pub fn doubt(&mut self, now: Duration, why: Doubted) {
        // a hiccup on top of something worse makes it no better
        let worse = self.doubt.map(|doubt| doubt.why).filter(|before| is_long(*before));
        self.doubt = Some(Doubt { since: now, why: worse.unwrap_or(why), asked: None, answered: false });
        self.asked = None;
    }

    /// The mode is not known.
    #[must_use]
    pub fn is_in_doubt(&self) -> bool {
        self.doubt.is_some()
    }

    /// The mode is not known, and was not for so long that setpoints are not to go out either.
    #[must_use]
    pub fn is_in_doubt_for_long(&self) -> bool {
        self.doubt.is_some_and(|doubt| is_long(doubt.why))
    }

    /// The number of the question by which the vehicle is to be asked now: because its mode is in doubt, or because a command
    /// waits for a report and reports may come as seldom as once a second. Numbers grow.
    pub fn asks(&mut self, now: Duration, waits: bool) -> Option<i64> {
        let wanted = waits || self.doubt.is_some();
        if !wanted || self.asked.is_some_and(|asked| now.saturating_sub(asked) < ASK_AGAIN) {
            return None;
        }
        self.asked = Some(now);
        let number = i64::try_from(now.as_nanos()).unwrap_or(i64::MAX).max(1);
        if let Some(doubt) = &mut self.doubt {
            doubt.asked.get_or_insert(number);
        }
        Some(number)
    }

    /// The vehicle answered the question of this number. Answers to questions from before the doubt count for nothing.
    pub fn answered(&mut self, number: i64) {
        if let Some(doubt) = &mut self.doubt {
            doubt.answered |= doubt.asked.is_some_and(|first| number >= first);
        }
    }

    /// A report of the mode was read.
    pub fn report(&mut self, now: Duration) {
        let counts = self.doubt.is_none_or(|doubt| {
            let read_by = match doubt.why {
                Doubted::Stall(_) => SOCKET_IS_READ,
                Doubted::Silence | Doubted::Contradiction => RADIO_IS_READ,
            };
            doubt.answered || doubt.asked.is_some() && now.saturating_sub(doubt.since) >= read_by
        });
        if counts {
            self.doubt = None;
            self.reports += 1;
        }
    }

    /// Reports that count so far. A command may go out once this is greater than when its reason came.
    #[must_use]
    pub fn reports(&self) -> u64 {
        self.reports
    }
}

fn is_long(why: Doubted) -> bool {
    !matches!(why, Doubted::Stall(gap) if gap < SHORT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    #[test]
    fn each_report_counts_while_nothing_is_in_doubt() {
        let mut known = ModeKnowledge::default();
        known.report(ms(0));
        known.report(ms(100));
        assert_eq!(known.reports(), 2);
        assert_eq!(known.asks(ms(100), false), None, "nothing is to be asked");
        assert!(known.asks(ms(110), true).is_some(), "a command waits");
    }

    #[test]
    fn after_a_stall_only_a_report_behind_an_answer_counts() {
        let mut known = ModeKnowledge::default();
        known.doubt(ms(1000), Doubted::Stall(ms(400)));
        let asked = known.asks(ms(1002), false).unwrap();
        known.answered(asked - 1);
        known.report(ms(1003));
        assert_eq!(known.reports(), 0, "an answer to an older question, and a report from before");
        assert_eq!(known.asks(ms(1100), true), None);
        assert!(known.asks(ms(1202), false).is_some_and(|again| again > asked));
        known.report(ms(1210));
        assert!(known.is_in_doubt());
        known.answered(asked);
        assert!(known.is_in_doubt(), "an answer alone says no mode");
        known.report(ms(1250));
        assert_eq!((known.reports(), known.is_in_doubt()), (1, false));
    }

    #[test]
    fn a_vehicle_that_answers_no_question_is_believed_later() {
        let mut known = ModeKnowledge::default();
        known.doubt(ms(0), Doubted::Silence);
        for t in (0..1500).step_by(100) {
            known.asks(ms(t), false);
            known.report(ms(t));
        }
        assert_eq!(known.reports(), 0);
        known.report(ms(1500));
        assert_eq!(known.reports(), 1);
    }

    #[test]
    fn a_second_stall_makes_the_first_answer_worthless() {
        let mut known = ModeKnowledge::default();
        known.doubt(ms(0), Doubted::Silence);
        let asked = known.asks(ms(0), false).unwrap();
        known.answered(asked);
        known.doubt(ms(50), Doubted::Stall(ms(120)));
        assert!(known.is_in_doubt_for_long(), "a hiccup makes a silence no shorter");
        known.report(ms(60));
        assert_eq!(known.reports(), 0);
    }
}
