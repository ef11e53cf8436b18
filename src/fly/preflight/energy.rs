//! The battery: charge for the flight and half of it again.

use crate::fly::finding::Finding;

/// Required charge as a multiple of that of the flight. For a second approach and for the estimate's own error; less
/// would land on an empty battery.
pub const SPARE_FACTOR: f64 = 1.5;

/// State of the battery.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BatteryState {
    /// percent of a full charge
    pub remaining_percent: Option<f64>,
    /// the autopilot calls it low or worse
    pub is_low: bool,
    /// s of hover that a full battery gives, from the operator
    pub endurance_s: Option<f64>,
}

/// The finding for a flight of this time (s) from ground to ground.
pub(super) fn finding(battery: &BatteryState, flight_s: f64) -> Finding {
    let needed_s = SPARE_FACTOR * flight_s;
    let expected = format!("charge for {needed_s:.0} s, {SPARE_FACTOR} times the flight");
    let remaining = battery.remaining_percent.map_or_else(
        || "a charge that the vehicle does not report".to_owned(),
        |percent| format!("{percent:.0} %"),
    );
    if battery.is_low {
        let came = format!("{remaining}, low by the autopilot's own judgement");
        return Finding::refusal("battery", expected, came, "charge it, or change it");
    }
    let (Some(percent), Some(endurance_s)) = (battery.remaining_percent, battery.endurance_s) else {
        let missing = match battery.endurance_s {
            None => "and how long a full one lasts is not known",
            Some(_) => "so how long it lasts is not known",
        };
        return Finding::warning(
            "battery",
            expected,
            format!("{remaining}, {missing}"),
            "see that it is charged; mavid fly takes the hover time of a full battery (--hover-time)",
        );
    };
    let lasts_s = 1e-2 * percent * endurance_s;
    let came = format!("{remaining}, about {lasts_s:.0} s");
    if lasts_s < needed_s || lasts_s.is_nan() {
        return Finding::refusal("battery", expected, came, "charge it, or plan fewer repeats");
    }
    Finding::ok("battery", expected, came)
}
