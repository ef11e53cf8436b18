//! What was met in a log that the vehicle wrote itself.

use crate::autopilot::VehicleKind;
use crate::recording::{LEAST_SAMPLES, LEAST_SPAN_S};

/// What was met in a log that the vehicle wrote itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OnboardReport {
    /// bytes read
    pub bytes: u64,
    /// messages read, definitions included
    pub messages: u64,
    /// what kind of vehicle it was, where the log says it
    pub kind: Option<VehicleKind>,
    /// the autopilot's software in its own words, such as `ArduCopter V4.5.7 (2a3dc4b7)`
    pub firmware: Option<String>,
    /// microseconds since 1970 UTC at which the recording's clock is zero, to a second or so, by a satellite receiver
    pub start_utc_us: Option<u64>,
    /// each kind of message that was read, by name
    pub topics: Vec<Topic>,
}

/// The messages of one name and instance.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Topic {
    /// as the log calls them
    pub name: String,
    /// 0 where there is one
    pub instance: u8,
    /// how many
    pub count: u64,
    /// first and last stamp, s of the vehicle's clock; `None` where they carry none
    pub span_s: Option<(f64, f64)>,
    /// pauses between these, as between two flights
    pub pauses: u64,
    /// s of them together
    pub paused_s: f64,
    /// samples of the recording come from them
    pub is_used: bool,
    /// their meaning is known, used or not; of PX4's only that of those that are used
    pub is_known: bool,
}

impl Topic {
    /// Messages a second between first and last, pauses left out; `None` below ten, within a tenth of a second, or without stamps.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let (first_s, last_s) = self.span_s?;
        let running_s = last_s - first_s - self.paused_s;
        let has_rate = self.count >= LEAST_SAMPLES && running_s >= LEAST_SPAN_S;
        has_rate.then(|| (self.count.saturating_sub(1 + self.pauses)) as f64 / running_s)
    }
}

/// Shortest pause, s: loads of an autopilot's card delay messages by less.
const LEAST_PAUSE_S: f64 = 3.0;
/// A pause is longer than so many mean periods before it.
const PAUSE_PERIODS: f64 = 30.0;

/// Whether nothing of these messages was logged for `step_s`, after `count` of them in `running_s`: they pause, as between two
/// flights, and do not come so seldom.
pub(super) fn is_pause(step_s: f64, running_s: f64, count: u64) -> bool {
    step_s > LEAST_PAUSE_S
        && count >= LEAST_SAMPLES
        && step_s * (count - 1) as f64 > PAUSE_PERIODS * running_s
}

#[cfg(test)]
mod tests {
    use super::{Topic, is_pause};

    #[test]
    fn few_messages_have_no_rate() {
        let of = |count, end_s| Topic { count, span_s: Some((1.0, end_s)), ..Topic::default() }.rate_hz();
        assert_eq!((of(3, 1.000_124), of(3, 9.0), of(100, 1.000_124)), (None, None, None));
        assert_eq!(of(11, 2.0), Some(10.0));
    }

    #[test]
    fn a_pause_between_two_flights_is_no_slow_rate() {
        // 10 Hz for 10 s, twice, ten minutes apart
        let topic =
            Topic { count: 202, span_s: Some((1.0, 621.0)), pauses: 1, paused_s: 600.0, ..Topic::default() };
        assert!((topic.rate_hz().unwrap() - 10.0).abs() < 1e-9);
        assert!(is_pause(600.0, 10.0, 101) && !is_pause(2.0, 10.0, 101));
        // a message each ten seconds, and one that has just begun
        assert!(!is_pause(60.0, 1000.0, 101) && !is_pause(600.0, 0.0, 1));
    }
}
