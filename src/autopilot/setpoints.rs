//! How an autopilot flies the setpoints of a program.

use std::time::Duration;

/// How a vehicle that flies setpoints gets into the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takeoff {
    /// it follows setpoints up
    BySetpoints,
    /// by `MAV_CMD_NAV_TAKEOFF`, in the mode that flies setpoints
    ByCommand,
}

/// What a vehicle does with its last setpoint while no other comes, until the time-out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LastSetpoint {
    /// flies it as it is
    Held,
    /// moves it on by its velocity and acceleration
    MovedOn,
}

/// How an autopilot flies the setpoints of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SetpointRules {
    /// the mode is entered only while setpoints arrive
    pub stream_before_mode: bool,
    /// pre-arm checks ask for a position only in the mode, so that they fail before
    pub position_checked_in_mode: bool,
    /// to arm may be answered by MAV_RESULT_FAILED for a while, and be accepted later
    pub failed_is_temporary: bool,
    /// into the air
    pub takeoff: Takeoff,
    /// while no setpoint comes
    pub last_setpoint: LastSetpoint,
    /// parameter with the time, in s, for which the last setpoint is flown
    pub timeout: &'static str,
    /// its default
    pub timeout_default: Duration,
}
