//! Frames of positions and velocities in messages (MAV_FRAME of MAVLink's `common.xml`), and a bit of their masks.

/// MAV_FRAME_LOCAL_NED.
pub const LOCAL_NED: u8 = 1;
/// MAV_FRAME_BODY_NED: the heading's, not the body's.
pub const BODY_NED: u8 = 8;
/// Bit of POSITION_TARGET_TYPEMASK: the acceleration is a force.
pub const FORCE_SET: u16 = 1 << 9;
