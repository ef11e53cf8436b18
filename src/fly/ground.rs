//! Whether the vehicle stands on the ground, by its reports.

use std::time::Duration;

use super::state::Timestamped;

/// "On the ground" is accepted if it was reported within the first of these times, and for the second time without a
/// pause of the first.
const VALID: (Duration, Duration) = (Duration::from_secs(2), Duration::from_secs(1));
/// After a jump of its clock, only repeated reports are accepted for this time, because old frames agree with one
/// another.
const CLOCK_SETTLES: Duration = Duration::from_secs(3);

/// Reports of EXTENDED_SYS_STATE, and reasons for doubt.
#[derive(Debug, Clone, Default)]
pub(super) struct Ground {
    said: Option<Timestamped<bool>>,
    /// since when it has reported "on the ground" without a pause
    since: Option<Duration>,
    /// it was ordered to take off and has not reported yet that it is in the air
    takes_off: bool,
    /// when its clock last jumped: it restarted, or old frames arrived
    jumped: Option<Duration>,
}

impl Ground {
    /// Takes a report of the vehicle.
    pub(super) fn report(&mut self, now: Duration, on_ground: bool) {
        self.takes_off &= on_ground;
        // a silence or a stall in between may have hidden that it said something else
        let goes_on = self.said.is_some_and(|said| now.saturating_sub(said.at) < VALID.0);
        self.since = on_ground.then(|| self.since.filter(|_| goes_on).unwrap_or(now));
        self.said = Some(Timestamped { at: now, value: on_ground });
    }

    /// Notes the order to take off: reports of the ground have little value until it has reported that it is in the
    /// air.
    pub(super) fn expect_takeoff(&mut self) {
        self.takes_off = true;
    }

    /// Notes that the vehicle's clock jumped.
    pub(super) fn clock_jumped(&mut self, now: Duration) {
        self.jumped = Some(now);
    }

    /// Whether its last report is that it stands on the ground.
    pub(super) fn is_said(&self) -> bool {
        self.said.is_some_and(|said| said.value)
    }

    /// Whether it reports the ground, recently and without another report for a while: single frames can be forged or
    /// old.
    pub(super) fn is_landed_at(&self, now: Duration) -> bool {
        let jumped = self.jumped.is_some_and(|at| now.saturating_sub(at) < CLOCK_SETTLES);
        let fresh = self.said.is_some_and(|said| now.saturating_sub(said.at) < VALID.0);
        let said = self.said.zip(self.since);
        let lasts = said.is_some_and(|(said, since)| said.at.saturating_sub(since) >= VALID.1);
        !self.takes_off && !jumped && fresh && lasts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    #[test]
    fn it_is_believed_once_it_is_said_for_a_second_and_while_it_is_said() {
        let mut ground = Ground::default();
        ground.report(ms(0), true);
        assert!(!ground.is_landed_at(ms(500)));
        ground.report(ms(1000), true);
        assert!(ground.is_landed_at(ms(1000)) && !ground.is_landed_at(ms(3000)), "an old word");
        ground.report(ms(3000), false);
        ground.report(ms(3100), true);
        assert!(!ground.is_landed_at(ms(3200)), "the second begins anew");
    }

    #[test]
    fn time_in_which_nothing_is_heard_does_not_count() {
        let mut ground = Ground::default();
        ground.report(ms(0), true);
        assert!(!ground.is_landed_at(ms(1500)), "said once");
        ground.report(ms(3700), true);
        assert!(!ground.is_landed_at(ms(3700)), "before and after a stall");
        ground.report(ms(4700), true);
        assert!(ground.is_landed_at(ms(4700)));
    }

    #[test]
    fn a_takeoff_and_a_clock_that_jumped_speak_against_it() {
        let mut ground = Ground::default();
        ground.expect_takeoff();
        for t in (0..5000).step_by(200) {
            ground.report(ms(t), true);
        }
        assert!(!ground.is_landed_at(ms(5000)));
        ground.report(ms(5000), false);
        for t in (5200..8000).step_by(200) {
            ground.report(ms(t), true);
        }
        assert!(ground.is_landed_at(ms(8000)));
        ground.clock_jumped(ms(8000));
        ground.report(ms(9000), true);
        assert!(!ground.is_landed_at(ms(9000)));
    }
}
