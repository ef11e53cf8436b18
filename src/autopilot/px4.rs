//! PX4.

use super::FlownBy::{self, Autopilot as Itself, Companion, Pilot};
use super::kind::Autopilot;
use super::modes::{FlightMode, Numbering, Wishes};
use super::setpoints::{LastSetpoint, SetpointRules, Takeoff};
use super::stack::Stack;
use std::time::Duration;

/// PX4: setpoints are flown in OFFBOARD, which wants a stream of them before it is entered.
pub static PX4: Stack = Stack {
    autopilot: Autopilot::Px4,
    name: "PX4",
    id: "px4",
    vehicles: "PX4 multicopter",
    mav_autopilot: 12,
    numbering: Numbering::MainAndSub,
    modes: &MODES,
    wishes: Wishes { external: OFFBOARD, hold: LOITER, land: LAND, home: RETURN },
    setpoints: SetpointRules {
        stream_before_mode: true,
        position_checked_in_mode: false,
        failed_is_temporary: false,
        takeoff: Takeoff::BySetpoints,
        last_setpoint: LastSetpoint::Held,
        timeout: "COM_OF_LOSS_T",
        timeout_default: Duration::from_secs(1),
    },
};

pub(crate) const ALTITUDE: FlightMode = mode(2, 0, "ALTCTL", "Altitude", Pilot, 1);
pub(crate) const POSITION: FlightMode = mode(3, 0, "POSCTL", "Position", Pilot, 2);
pub(crate) const TAKEOFF: FlightMode = mode(AUTO, 2, "AUTO.TAKEOFF", "Takeoff", Itself, 10);
pub(crate) const LOITER: FlightMode = mode(AUTO, 3, "AUTO.LOITER", "Hold", Itself, 4);
pub(crate) const RETURN: FlightMode = mode(AUTO, 5, "AUTO.RTL", "Return", Itself, 5);
pub(crate) const LAND: FlightMode = mode(AUTO, 6, "AUTO.LAND", "Land", Itself, 11);
pub(crate) const OFFBOARD: FlightMode = mode(6, 0, "OFFBOARD", "Offboard", Companion, 7);
pub(crate) const STABILIZED: FlightMode = mode(7, 0, "STABILIZED", "Stabilized", Pilot, 8);

/// Main mode of all AUTO modes.
const AUTO: u8 = 4;
/// No switch leads there.
const NONE: i32 = -1;

/// Numbers and names by `px4_custom_mode.h`, titles by `nav_state_names`, switches by COM_FLTMODE1; release 1.16.
const MODES: [FlightMode; 28] = [
    mode(1, 0, "MANUAL", "Manual", Pilot, 0),
    ALTITUDE,
    POSITION,
    mode(3, 1, "POSCTL.ORBIT", "Orbit", Itself, NONE),
    mode(3, 2, "POSCTL.SLOW", "Position Slow", Pilot, 9),
    mode(AUTO, 1, "AUTO.READY", "Ready", Itself, NONE),
    TAKEOFF,
    LOITER,
    mode(AUTO, 4, "AUTO.MISSION", "Mission", Itself, 3),
    RETURN,
    LAND,
    mode(AUTO, 8, "AUTO.FOLLOW_TARGET", "Follow Target", Itself, 12),
    mode(AUTO, 9, "AUTO.PRECLAND", "Precision Landing", Itself, 13),
    mode(AUTO, 10, "AUTO.VTOL_TAKEOFF", "VTOL Takeoff", Itself, NONE),
    mode(AUTO, 11, "AUTO.EXTERNAL1", "External 1", Companion, 100),
    mode(AUTO, 12, "AUTO.EXTERNAL2", "External 2", Companion, 101),
    mode(AUTO, 13, "AUTO.EXTERNAL3", "External 3", Companion, 102),
    mode(AUTO, 14, "AUTO.EXTERNAL4", "External 4", Companion, 103),
    mode(AUTO, 15, "AUTO.EXTERNAL5", "External 5", Companion, 104),
    mode(AUTO, 16, "AUTO.EXTERNAL6", "External 6", Companion, 105),
    mode(AUTO, 17, "AUTO.EXTERNAL7", "External 7", Companion, 106),
    mode(AUTO, 18, "AUTO.EXTERNAL8", "External 8", Companion, 107),
    mode(5, 0, "ACRO", "Acro", Pilot, 6),
    OFFBOARD,
    STABILIZED,
    // of older releases
    mode(8, 0, "RATTITUDE", "Rattitude", Pilot, NONE),
    mode(10, 0, "TERMINATION", "Termination", Itself, NONE),
    // a main mode whose sub mode is not said
    mode(AUTO, 0, "AUTO", "Auto", Itself, NONE),
];

const fn mode(
    main: u8,
    sub: u8,
    name: &'static str,
    title: &'static str,
    flown_by: FlownBy,
    switch: i32,
) -> FlightMode {
    let switch = if switch == NONE { None } else { Some(switch) };
    FlightMode { number: Numbering::MainAndSub.number(main, sub), name, title, flown_by, switch }
}
