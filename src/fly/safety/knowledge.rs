//! Whether the vehicle's mode is known well enough to command it.
//!
//! A report of the mode that was read counts. After a stall of this program or a silence of the vehicle no report
//! counts at first: what is read then may have been sent long ago, and no time tells when a queue on the way has
//! drained. The vehicle is asked, and a report counts again once it was sent after the vehicle's answer to a question
//! that was asked after the stall or the silence. A vehicle that does not hear the question does not hear a command
//! either, so that nothing is lost by waiting; one that never answers is not flown.
//!
//! The questions are numbered (TIMESYNC gives the number back), from a number on that is drawn again for every run of
//! the program: the vehicle's answers to others, which routers pass on, are not taken for answers to us, and an older
//! answer is not taken for the newer one's.

use std::hash::{BuildHasher, RandomState};
use std::time::Duration;

/// Time between two requests.
const ASK_AGAIN: Duration = Duration::from_millis(200);
/// After a shorter stall, commands wait for a report but setpoints do not. After a longer one a flight is not continued.
pub(in crate::fly) const SHORT: Duration = Duration::from_millis(300);

/// The reason why the mode is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Doubted {
    /// this program stalled for this time
    Stall(Duration),
    /// the vehicle was not heard
    Silence,
    /// another mode was reported by a frame that was sent before the last report, as far as sequence numbers tell
    Contradiction,
}

/// The number of the first request of one run of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FirstQuestion(i64);

impl FirstQuestion {
    /// Least number of a question: clocks, which others send as numbers, count nanoseconds and do not reach it before
    /// the year 2043.
    const LEAST: i64 = 1 << 61;

    /// Of a seed: the same for the same.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        Self(Self::LEAST | (seed >> 3).cast_signed())
    }

    /// A new one, drawn from the randomness that the system gives every process for its hash tables.
    #[must_use]
    pub fn random() -> Self {
        Self::of_seed(RandomState::new().hash_one(0_u8))
    }
}

/// The reason of a doubt, and the requests about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Doubt {
    /// since when the mode is not known
    since: Duration,
    why: Doubted,
    /// number of the first question that went out since the last event that made it uncertain
    asked: Option<i64>,
    /// place of the answer among the frames that the vehicle sent
    answered: Option<i64>,
}

/// Number of accepted reports of the mode, and whether new ones are accepted.
#[derive(Debug, Clone)]
pub struct ModeKnowledge {
    reports: u64,
    doubt: Option<Doubt>,
    asked: Option<Duration>,
    /// of the run's first question, and of the next one
    first: i64,
    next: i64,
    ever_answered: bool,
}

impl ModeKnowledge {
    /// Questions are counted from this number on.
    #[must_use]
    pub fn new(FirstQuestion(first): FirstQuestion) -> Self {
        Self { reports: 0, doubt: None, asked: None, first, next: first, ever_answered: false }
    }

    /// Notes that the mode is not known from now on: this program stalled, or the vehicle was silent.
    pub fn doubt(&mut self, now: Duration, why: Doubted) {
        // a hiccup on top of something worse makes it no better
        let worse = self.doubt.map(|doubt| doubt.why).filter(|before| is_long(*before));
        let since = self.doubt.map_or(now, |doubt| doubt.since);
        self.doubt = Some(Doubt { since, why: worse.unwrap_or(why), asked: None, answered: None });
        self.asked = None;
    }

    /// Whether the mode is not known.
    #[must_use]
    pub fn is_in_doubt(&self) -> bool {
        self.doubt.is_some()
    }

    /// Since when the mode is not known; `None` while it is.
    #[must_use]
    pub fn unknown_since(&self) -> Option<Duration> {
        self.doubt.map(|doubt| doubt.since)
    }

    /// Whether the mode has been unknown for so long that no setpoints may be sent either.
    #[must_use]
    pub fn is_in_doubt_for_long(&self) -> bool {
        self.doubt.is_some_and(|doubt| is_long(doubt.why))
    }

    /// Whether the vehicle answers requests: it answered one of this run.
    #[must_use]
    pub fn has_answers(&self) -> bool {
        self.ever_answered
    }

    /// The number of the request to be sent now: its mode is in doubt, or an answer is wanted because a command waits
    /// for a report, which may come only once a second. Numbers increase.
    pub fn asks(&mut self, now: Duration, wanted: bool) -> Option<i64> {
        let wanted = wanted || self.doubt.is_some();
        if !wanted || self.asked.is_some_and(|asked| now.saturating_sub(asked) < ASK_AGAIN) {
            return None;
        }
        self.asked = Some(now);
        let number = self.next;
        self.next = self.next.saturating_add(1);
        if let Some(doubt) = &mut self.doubt {
            doubt.asked.get_or_insert(number);
        }
        Some(number)
    }

    /// Takes the answer to the request of this number, from a frame with this place among those that the vehicle sent.
    /// Answers to requests of others, and to ours from before the doubt, do not count.
    pub fn answered(&mut self, number: i64, place: i64) {
        self.ever_answered |= (self.first..self.next).contains(&number);
        if let Some(doubt) = &mut self.doubt
            && doubt.asked.is_some_and(|asked| (asked..self.next).contains(&number))
        {
            doubt.answered = Some(doubt.answered.map_or(place, |before| before.min(place)));
        }
    }

    /// Takes a report of the mode from a frame with this place among those that the vehicle sent.
    pub fn report(&mut self, place: i64) {
        if self.doubt.is_none_or(|doubt| doubt.answered.is_some_and(|answer| place > answer)) {
            self.doubt = None;
            self.reports += 1;
        }
    }

    /// Number of accepted reports. A command may be sent once it is greater than at the time of the command's reason.
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

    fn knowledge() -> ModeKnowledge {
        ModeKnowledge::new(FirstQuestion::of_seed(1))
    }

    #[test]
    fn each_report_counts_while_nothing_is_in_doubt() {
        let mut known = knowledge();
        known.report(1);
        known.report(2);
        assert_eq!(known.reports(), 2);
        assert_eq!(known.asks(ms(100), false), None, "nothing is to be asked");
        assert!(known.asks(ms(110), true).is_some(), "a command waits");
    }

    #[test]
    fn after_a_stall_only_a_report_behind_an_answer_counts() {
        let mut known = knowledge();
        let before = known.asks(ms(900), true).unwrap();
        known.doubt(ms(1000), Doubted::Stall(ms(400)));
        let asked = known.asks(ms(1002), false).unwrap();
        known.answered(before, 10);
        known.report(11);
        assert_eq!(known.reports(), 0, "an answer to an older question, and a report from before");
        assert_eq!(known.asks(ms(1100), true), None);
        assert!(known.asks(ms(1202), false).is_some_and(|again| again > asked));
        known.report(12);
        assert!(known.is_in_doubt());
        known.answered(asked, 20);
        assert!(known.is_in_doubt(), "an answer alone says no mode");
        known.report(19);
        assert!(known.is_in_doubt(), "a report that was sent before the answer and overtaken by it");
        known.report(21);
        assert_eq!((known.reports(), known.is_in_doubt()), (1, false));
    }

    #[test]
    fn answers_to_the_questions_of_others_count_for_nothing() {
        let mut known = knowledge();
        known.doubt(ms(0), Doubted::Silence);
        let asked = known.asks(ms(0), false).unwrap();
        let epoch_ns = 1_760_000_000_000_000_000;
        for number in [1, 5_000_000_000, epoch_ns, asked - 1, asked + 1, i64::MAX, -asked] {
            known.answered(number, 1);
            known.report(2);
            assert!(known.is_in_doubt() && !known.has_answers(), "{number}");
        }
        known.answered(asked, 3);
        known.report(4);
        assert!(!known.is_in_doubt() && known.has_answers());
    }

    #[test]
    fn a_vehicle_that_answers_no_question_is_never_believed() {
        for why in [Doubted::Silence, Doubted::Contradiction, Doubted::Stall(ms(150))] {
            let mut known = knowledge();
            known.doubt(ms(0), why);
            for t in (0..60_000).step_by(100) {
                known.asks(ms(t), false);
                known.report(i64::try_from(t).unwrap());
            }
            assert_eq!((known.reports(), known.unknown_since()), (0, Some(ms(0))), "{why:?}");
        }
    }

    #[test]
    fn a_second_stall_makes_the_first_answer_worthless() {
        let mut known = knowledge();
        known.doubt(ms(10), Doubted::Silence);
        let asked = known.asks(ms(10), false).unwrap();
        known.answered(asked, 1);
        known.doubt(ms(50), Doubted::Stall(ms(120)));
        assert!(known.is_in_doubt_for_long(), "a hiccup makes a silence no shorter");
        known.report(2);
        assert_eq!((known.reports(), known.unknown_since()), (0, Some(ms(10))));
    }

    #[test]
    fn numbers_of_two_runs_are_far_apart_and_no_clocks() {
        let year_2040_ns = 2_208_988_800_000_000_000;
        for seed in [0, 1, u64::MAX] {
            let first = FirstQuestion::of_seed(seed).0;
            assert!(first > year_2040_ns && first <= i64::MAX / 2, "{first}");
        }
        assert_ne!(FirstQuestion::random(), FirstQuestion::random());
    }
}
