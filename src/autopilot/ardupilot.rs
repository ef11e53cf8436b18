//! ArduPilot's multirotor, ArduCopter.

use super::FlownBy::{self, Autopilot as Itself, Companion, Pilot};
use super::kind::Autopilot;
use super::modes::{FlightMode, Numbering, Wishes};
use super::setpoints::{LastSetpoint, SetpointRules, Takeoff};
use super::stack::Stack;
use std::time::Duration;

/// ArduCopter: setpoints are flown in GUIDED, after a takeoff by command.
pub static ARDUPILOT: Stack = Stack {
    autopilot: Autopilot::ArduPilot,
    name: "ArduPilot",
    id: "ardupilot",
    vehicles: "ArduCopter",
    mav_autopilot: 3,
    numbering: Numbering::Whole,
    modes: &MODES,
    // LOITER holds too, and is never asked for: it is a pilot's
    wishes: Wishes { external: GUIDED, hold: BRAKE, land: LAND, home: RETURN },
    setpoints: SetpointRules {
        stream_before_mode: false,
        position_checked_in_mode: true,
        failed_is_temporary: true,
        takeoff: Takeoff::ByCommand,
        last_setpoint: LastSetpoint::MovedOn,
        timeout: "GUID_TIMEOUT",
        timeout_default: Duration::from_secs(3),
    },
};

pub(crate) const STABILIZE: FlightMode = mode(0, "STABILIZE", Pilot);
pub(crate) const ALT_HOLD: FlightMode = mode(2, "ALT_HOLD", Pilot);
pub(crate) const GUIDED: FlightMode = mode(4, "GUIDED", Companion);
pub(crate) const LOITER: FlightMode = mode(5, "LOITER", Pilot);
pub(crate) const RETURN: FlightMode = mode(6, "RTL", Itself);
pub(crate) const LAND: FlightMode = mode(9, "LAND", Itself);
pub(crate) const POSHOLD: FlightMode = mode(16, "POSHOLD", Pilot);
pub(crate) const BRAKE: FlightMode = mode(17, "BRAKE", Itself);

/// Numbers and names of COPTER_MODE in the message definitions. A mode switch takes the same numbers.
const MODES: [FlightMode; 26] = [
    STABILIZE,
    mode(1, "ACRO", Pilot),
    ALT_HOLD,
    mode(3, "AUTO", Itself),
    GUIDED,
    LOITER,
    RETURN,
    mode(7, "CIRCLE", Itself),
    LAND,
    mode(11, "DRIFT", Pilot),
    mode(13, "SPORT", Pilot),
    mode(14, "FLIP", Itself),
    mode(15, "AUTOTUNE", Pilot),
    POSHOLD,
    BRAKE,
    mode(18, "THROW", Itself),
    mode(19, "AVOID_ADSB", Itself),
    mode(20, "GUIDED_NOGPS", Companion),
    mode(21, "SMART_RTL", Itself),
    mode(22, "FLOWHOLD", Pilot),
    mode(23, "FOLLOW", Itself),
    mode(24, "ZIGZAG", Pilot),
    mode(25, "SYSTEMID", Pilot),
    mode(26, "AUTOROTATE", Itself),
    mode(27, "AUTO_RTL", Itself),
    mode(28, "TURTLE", Pilot),
];

const fn mode(number: u8, name: &'static str, flown_by: FlownBy) -> FlightMode {
    let switch = Some(number as i32);
    FlightMode { number: Numbering::Whole.number(number, 0), name, title: name, flown_by, switch }
}
