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
    /// samples of the recording come from them
    pub is_used: bool,
    /// their meaning is known, used or not; of PX4's only that of those that are used
    pub is_known: bool,
}

impl Topic {
    /// Messages a second between first and last; `None` below ten, within a tenth of a second, or without stamps.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let (first_s, last_s) = self.span_s?;
        let has_rate = self.count >= LEAST_SAMPLES && last_s - first_s >= LEAST_SPAN_S;
        has_rate.then(|| (self.count - 1) as f64 / (last_s - first_s))
    }
}

#[cfg(test)]
mod tests {
    use super::Topic;

    #[test]
    fn few_messages_have_no_rate() {
        let of = |count, end_s| Topic { count, span_s: Some((1.0, end_s)), ..Topic::default() }.rate_hz();
        assert_eq!((of(3, 1.000_124), of(3, 9.0), of(100, 1.000_124)), (None, None, None));
        assert_eq!(of(11, 2.0), Some(10.0));
    }
}
