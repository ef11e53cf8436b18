//! Whom a message is for.

use crate::log::{Frame, Vehicle};

/// Target system and component of a message to a vehicle; a system id that has no room in one byte is
/// addressed as all.
pub(super) fn target_of(vehicle: &Vehicle) -> (u8, u8) {
    (u8::try_from(vehicle.system.0).unwrap_or(0), vehicle.component.0)
}

/// The frame comes from the vehicle's autopilot.
pub(super) fn is_from(vehicle: &Vehicle, frame: &Frame<'_>) -> bool {
    let header = frame.header();
    header.system == vehicle.system && header.component == vehicle.component
}

/// MAVLink's floats have 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "rounding to the message's precision is what is wanted")]
pub(super) fn single(value: f64) -> f32 {
    value as f32
}
