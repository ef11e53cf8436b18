//! Whether the motors may turn, as far as the vehicle is believed.

use std::time::Duration;

/// A vehicle that says "disarmed" with nothing else to agree is believed after so long and so many reports.
const PERSISTS: Duration = Duration::from_millis(2500);
const REPORTS: u32 = 3;
/// Words further apart than this are not said in a row.
const APART: Duration = Duration::from_secs(2);

/// Armed or not. One HEARTBEAT can be forged or damaged, and a vehicle that is wrongly taken for disarmed loses its
/// supervision in the air. "Armed" is believed at once; "disarmed" once the vehicle says too that it stands on the
/// ground, or once it says so again and again.
#[derive(Debug, Clone, Default)]
pub(super) struct Arming {
    armed: bool,
    /// since when, until when, and how often in a row, "disarmed" is said of what is believed to be armed
    contradicted: Option<(Duration, Duration, u32)>,
}

impl Arming {
    /// Takes a HEARTBEAT's word. `on_ground`: the vehicle has said for a while that it stands on the ground.
    pub(super) fn report(&mut self, now: Duration, armed: bool, on_ground: bool) {
        if armed || !self.armed {
            (self.armed, self.contradicted) = (armed, None);
            return;
        }
        let in_a_row = self.contradicted.filter(|(_, last, _)| now.saturating_sub(*last) <= APART);
        let (since, _, count) = in_a_row.unwrap_or((now, now, 0));
        let count = count.saturating_add(1);
        self.contradicted = Some((since, now, count));
        if on_ground || count >= REPORTS && now.saturating_sub(since) >= PERSISTS {
            (self.armed, self.contradicted) = (false, None);
        }
    }

    /// The motors may turn.
    pub(super) fn is_armed(&self) -> bool {
        self.armed
    }

    /// The last word was "disarmed", and it is not believed yet.
    pub(super) fn is_contradicted(&self) -> bool {
        self.contradicted.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    fn armed() -> Arming {
        let mut arming = Arming::default();
        arming.report(ms(0), true, false);
        assert!(arming.is_armed());
        arming
    }

    #[test]
    fn a_single_word_in_the_air_is_not_believed() {
        let mut arming = armed();
        arming.report(ms(1000), false, false);
        assert!(arming.is_armed() && arming.is_contradicted());
        arming.report(ms(1200), true, false);
        assert!(arming.is_armed() && !arming.is_contradicted());
    }

    #[test]
    fn three_in_a_row_over_seconds_are_believed_and_a_burst_is_not() {
        let mut arming = armed();
        for t in 1000..1010 {
            arming.report(ms(t), false, false);
        }
        assert!(arming.is_armed(), "ten within ten milliseconds");
        arming.report(ms(3100), false, false);
        assert!(arming.is_armed(), "two seconds without a word");
        for t in [4100, 5100] {
            arming.report(ms(t), false, false);
            assert!(arming.is_armed());
        }
        arming.report(ms(6100), false, false);
        assert!(!arming.is_armed());
    }

    #[test]
    fn on_the_ground_the_first_word_counts() {
        let mut arming = armed();
        arming.report(ms(1000), false, true);
        assert!(!arming.is_armed());
        arming.report(ms(1100), true, true);
        assert!(arming.is_armed(), "armed is believed at once");
    }
}
