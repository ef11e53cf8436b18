//! What was met in a log that the vehicle wrote itself.

use crate::autopilot::VehicleKind;

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
    /// Messages a second between first and last; `None` below two, or without stamps.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let (first_s, last_s) = self.span_s?;
        (self.count > 1 && last_s > first_s).then(|| (self.count - 1) as f64 / (last_s - first_s))
    }
}
