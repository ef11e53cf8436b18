//! The embedded vehicle as both autopilots: modes, arming, failsafes, setpoints, parameters, telemetry. No I/O
//! and no real time: the clock is the test's.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

#[path = "../support/ground.rs"]
mod ground;

mod ardupilot;
mod both;
mod onboard_logs;
mod px4;
mod telemetry;

use ground::Ground;
use mavid::sitl::Firmware;

const PX4: Firmware = Firmware::PX4;
const COPTER: Firmware = Firmware::ARDUPILOT_4_7;
const COPTER_4_6: Firmware = Firmware::ARDUPILOT_4_6;

/// MAV_RESULT.
const ACCEPTED: u8 = 0;
const TEMPORARILY_REJECTED: u8 = 1;
const DENIED: u8 = 2;
const UNSUPPORTED: u8 = 3;
const FAILED: u8 = 4;

/// North, east, down as asked, within `within_m`.
fn assert_at(ground: &Ground, place: [f64; 3], within_m: f64) {
    let at = ground.position();
    for (got, want) in at.iter().zip(place) {
        assert!((got - want).abs() < within_m, "at {at:?}, expected {place:?}: {:?}", ground.texts());
    }
}
