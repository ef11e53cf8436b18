//! Numbers of commands and their results (MAVLink's `common.xml`).

/// MAV_CMD_SET_MESSAGE_INTERVAL.
pub const SET_MESSAGE_INTERVAL: u16 = 511;
/// Second parameter of MAV_CMD_COMPONENT_ARM_DISARM that arms and disarms in any state.
pub const ARM_BY_FORCE: f32 = 21_196.0;
/// MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, of `base_mode`.
pub const CUSTOM_MODE: u8 = 1;

/// MAV_RESULT_ACCEPTED.
pub const ACCEPTED: u8 = 0;
/// MAV_RESULT_TEMPORARILY_REJECTED.
pub const TEMPORARILY_REJECTED: u8 = 1;
/// MAV_RESULT_FAILED.
pub const FAILED: u8 = 4;
/// MAV_RESULT_IN_PROGRESS.
pub const IN_PROGRESS: u8 = 5;
