//! HEARTBEAT: the places of what it tells in its payload, and their values (MAVLink's `minimal.xml`).

use std::time::Duration;

/// Time between two of them.
pub const HEARTBEAT_PERIOD: Duration = Duration::from_secs(1);
/// Place of `type`, MAV_TYPE.
pub const TYPE_AT: usize = 4;
/// Place of `autopilot`, MAV_AUTOPILOT.
pub const AUTOPILOT_AT: usize = 5;
/// `autopilot` of what is no vehicle: MAV_AUTOPILOT_INVALID.
pub const NO_AUTOPILOT: u8 = 8;
/// Place of `base_mode`, MAV_MODE_FLAG.
pub const BASE_MODE_AT: usize = 6;
/// Bit of `base_mode`: MAV_MODE_FLAG_SAFETY_ARMED.
pub const ARMED: u8 = 0x80;
