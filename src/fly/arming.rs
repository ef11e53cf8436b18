//! Whether the motors may turn, by the vehicle's reports.

use std::time::Duration;

/// A vehicle that reports "disarmed" without another message that agrees is accepted as disarmed after this time and
/// this number of reports.
const PERSISTS: Duration = Duration::from_millis(2500);
const REPORTS: u32 = 3;
/// Reports further apart than this are not consecutive.
const APART: Duration = Duration::from_secs(2);

/// Armed or not. A single HEARTBEAT can be forged or damaged, and a vehicle that is wrongly taken for disarmed loses
/// its supervision in the air. "Armed" is accepted immediately. "Disarmed" is accepted if the vehicle also reports that
/// it stands on the ground, or if it repeats the report.
#[derive(Debug, Clone, Default)]
pub(super) struct Arming {
    armed: bool,
    /// first time, last time and number of consecutive reports of "disarmed" while the vehicle counts as armed
    contradicted: Option<(Duration, Duration, u32)>,
}

impl Arming {
    /// Takes the report of a HEARTBEAT. `on_ground`: the vehicle has reported for a while that it stands on the ground.
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

    /// Whether the motors may turn.
    pub(super) fn is_armed(&self) -> bool {
        self.armed
    }

    /// Whether the last report was "disarmed" and is not accepted yet.
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
