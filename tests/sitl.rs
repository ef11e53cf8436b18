//! The embedded vehicle as both autopilots: modes, arming, failsafes, setpoints, telemetry. No I/O, no real
//! time: the clock is the test's.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

#[path = "support/ground.rs"]
mod ground;

use ground::{Ground, Target};
use mavid::sitl::{ArduPilotRelease, AutopilotKind, Mode};

const PX4: AutopilotKind = AutopilotKind::Px4;
const COPTER: AutopilotKind = AutopilotKind::ArduPilot(ArduPilotRelease::V4_7);

#[test]
fn px4_flies_offboard_to_a_position_and_lands() {
    let mut ground = Ground::of(PX4);
    ground.wait(3.0);
    let goal = Target::at([2.0, -1.5, -3.0]).message();
    ground.stream(1.5, &goal);
    assert_eq!(ground.set_mode(Mode::Guided), 0);
    assert_eq!(ground.arm(), 0, "{:?}", ground.texts());
    ground.stream(15.0, &goal);
    assert_eq!(ground.mode(), Some(Mode::Guided));
    let [north, east, down] = ground.position();
    assert!(
        (north - 2.0).abs() < 0.1 && (east + 1.5).abs() < 0.1 && (down + 3.0).abs() < 0.1,
        "{north} {east} {down}"
    );
    assert_eq!(ground.command(21, [0.0; 7]), 0);
    ground.wait(15.0);
    assert!(!ground.is_armed(), "{:?} {:?}", ground.position(), ground.texts());
    assert!(ground.position()[2].abs() < 0.2);
}

#[test]
fn copter_takes_off_in_guided_flies_to_a_position_and_lands() {
    let mut ground = Ground::of(COPTER);
    ground.take_off(3.0);
    let goal = Target::at([2.0, -1.5, -3.0]).message();
    ground.stream(15.0, &goal);
    let [north, east, down] = ground.position();
    assert!(
        (north - 2.0).abs() < 0.1 && (east + 1.5).abs() < 0.1 && (down + 3.0).abs() < 0.1,
        "{north} {east} {down}"
    );
    assert_eq!(ground.set_mode(Mode::Land), 0);
    ground.wait(18.0);
    assert!(!ground.is_armed(), "{:?} {:?}", ground.position(), ground.texts());
}
