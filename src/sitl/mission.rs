//! What a ground station has stored on the vehicle: a fence to be read; uploads are refused.

use super::message::Message;
use crate::units::whole;

/// One item of a stored fence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FenceItem {
    /// MAV_CMD: 5001 corner of a polygon to stay in, 5002 to stay out of, 5003 and 5004 the same of circles
    pub command: u16,
    /// corners of the polygon, or radius of the circle, m
    pub param1: f64,
    /// degrees north
    pub latitude_deg: f64,
    /// degrees east
    pub longitude_deg: f64,
}

/// MAV_MISSION_TYPE_FENCE
pub(super) const FENCE: u8 = 1;
/// MAV_FRAME_GLOBAL
const GLOBAL: u8 = 0;

/// MAV_MISSION_RESULT.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MissionResult {
    Unsupported = 3,
    InvalidSequence = 13,
}

/// MISSION_COUNT.
pub(super) fn count(items: usize, (system, component): (u8, u8), mission_type: u8) -> Message {
    let items = u16::try_from(items).unwrap_or(u16::MAX);
    Message::new(44).u16(items).u8(system).u8(component).u8(mission_type).u32(0)
}

/// MISSION_ITEM_INT.
pub(super) fn item(item: &FenceItem, sequence: u16, (system, component): (u8, u8)) -> Message {
    Message::new(73)
        .f32s(&[item.param1, 0.0, 0.0, 0.0])
        .i32(whole(item.latitude_deg * 1e7))
        .i32(whole(item.longitude_deg * 1e7))
        .f32(0.0)
        .u16(sequence)
        .u16(item.command)
        .u8(system)
        .u8(component)
        .u8(GLOBAL)
        .u8(0)
        .u8(1)
        .u8(FENCE)
}

/// MISSION_ACK.
pub(super) fn acknowledged(
    result: MissionResult,
    (system, component): (u8, u8),
    mission_type: u8,
) -> Message {
    Message::new(47).u8(system).u8(component).u8(result as u8).u8(mission_type).u32(0)
}
