//! A stamp that leaps ahead: time that passed, or damage. The following stamps decide. Messages are buffered until then.
//! A sound log loses none, and a damaged one does not get longer.

/// So many stamps from before a leap that threads do not explain, behind it: it was damage.
const BACK: usize = 2;
/// The same behind a shorter leap. Each topic's next message may be from before a pause: damage brings more of them.
const BACK_SHORT: usize = 64;
/// So many at or after it, itself among them: time passed.
const AHEAD: usize = 8;
/// No more messages wait.
const MOST: usize = 256;
/// Messages of several threads run back by less, s.
const THREADS_S: f64 = 10.0;
/// The last stamp of a log leaps by no more, s: nothing behind it tells. A vehicle that rests writes something each half a minute.
const LAST_S: f64 = 60.0;

/// A leap, and the messages from it on.
#[derive(Debug)]
pub(super) struct Leap<T> {
    before_s: f64,
    leapt_s: f64,
    ahead: usize,
    back: usize,
    /// stamps of another time
    elsewhere: usize,
    waiting: Vec<(Side, T)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Ahead,
    Other,
}

/// What a leap was.
#[derive(Debug)]
pub(super) enum LeapCause<T> {
    /// time that passed: the messages from it on, itself the first
    Passed(Vec<T>),
    /// damage: how many messages bore it, and the others since then
    Damage(usize, Vec<T>),
}

impl<T> Leap<T> {
    /// A message's stamp leaps, from `before_s` to `leapt_s`.
    pub(super) fn new(before_s: f64, leapt_s: f64, message: T) -> Self {
        Self { before_s, leapt_s, ahead: 1, back: 0, elsewhere: 0, waiting: vec![(Side::Ahead, message)] }
    }

    /// Takes the message behind; `true` where it tells, or no more can wait.
    pub(super) fn wait(&mut self, stamp_s: Option<f64>, message: T) -> bool {
        let behind_s = THREADS_S.min(0.5 * (self.leapt_s - self.before_s));
        let is_ahead = stamp_s.is_some_and(|stamp_s| stamp_s >= self.leapt_s - behind_s);
        let is_back = !is_ahead && stamp_s.is_some_and(|stamp_s| stamp_s >= self.before_s - THREADS_S);
        self.ahead += usize::from(is_ahead);
        self.back += usize::from(is_back);
        self.elsewhere += usize::from(stamp_s.is_some() && !is_ahead && !is_back);
        self.waiting.push((if is_ahead { Side::Ahead } else { Side::Other }, message));
        self.is_ahead() || self.back >= self.enough() || self.waiting.len() >= MOST
    }

    /// Stamps go on from it.
    fn is_ahead(&self) -> bool {
        self.ahead >= AHEAD && self.ahead > self.elsewhere
    }

    /// So many stamps from before the leap tell that it was damage.
    fn enough(&self) -> usize {
        if self.leapt_s - self.before_s > THREADS_S { BACK } else { BACK_SHORT }
    }

    /// What it was, as far as it has been told.
    pub(super) fn resolve(self) -> LeapCause<T> {
        let is_last = self.ahead == 1 && self.leapt_s - self.before_s > LAST_S;
        let is_told = self.is_ahead() || self.ahead > self.back.max(self.elsewhere);
        let has_passed = self.back < self.enough() && is_told && !is_last;
        let messages = self.waiting.into_iter();
        if has_passed {
            return LeapCause::Passed(messages.map(|(_, message)| message).collect());
        }
        let others = messages.filter(|(side, _)| *side == Side::Other);
        LeapCause::Damage(self.ahead, others.map(|(_, message)| message).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{BACK_SHORT, Leap, LeapCause, MOST};

    /// What follows on a leap from 100 s; how many were damaged, and how many messages are left.
    fn settled(leapt_s: f64, stamps_s: &[f64]) -> (usize, usize) {
        let mut leap = Leap::new(100.0, leapt_s, leapt_s);
        for stamp_s in stamps_s {
            if leap.wait(Some(*stamp_s), *stamp_s) {
                break;
            }
        }
        match leap.resolve() {
            LeapCause::Passed(messages) => (0, messages.len()),
            LeapCause::Damage(damaged, others) => (damaged, others.len()),
        }
    }

    #[test]
    fn what_follows_tells_a_pause_from_damage() {
        let of = |stamps_s: &[f64]| settled(1100.0, stamps_s);
        // stamps go on from it, near or far
        assert_eq!((of(&[1100.1; 9]), of(&[1131.0, 1162.0, 1193.0])), ((0, 8), (0, 4)));
        // taken back, after one and after three
        assert_eq!((of(&[100.1, 100.2]), of(&[131.0, 162.0])), ((1, 2), (1, 2)));
        assert_eq!(of(&[1100.0, 1100.1, 100.1, 100.2]), (3, 2));
        // one of the old time that was late, and one that is damaged itself
        assert_eq!(of(&[99.9, 1100.0, 9.0, 1100.1, 1100.2, 1100.2, 1100.2, 1100.3, 1100.3]), (0, 10));
        // the log ends
        assert_eq!((of(&[1100.1]), of(&[]), of(&[100.1])), ((0, 2), (1, 0), (1, 1)));
        assert_eq!(settled(131.0, &[]), (0, 1));
        // nothing goes on from it, nor from before it
        assert_eq!(settled(1100.0, &[50.0; 300]), (1, MOST - 1));
    }

    #[test]
    fn behind_a_short_pause_the_topics_catch_up() {
        let late: Vec<f64> = (0..40).map(|index| if index % 4 == 3 { 108.0 } else { 100.5 }).collect();
        assert_eq!(settled(108.0, &late), (0, 29));
        // one stamp ahead, and the others go on as before
        let onward: Vec<f64> = (0..100).map(|index| 100.0 + 0.01 * f64::from(index)).collect();
        assert_eq!(settled(108.0, &onward), (1, BACK_SHORT));
    }
}
