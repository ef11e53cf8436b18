//! The sender of a message.

use crate::wire::{Frame, Vehicle};

/// Whether the frame comes from the vehicle's autopilot.
pub(super) fn is_from(vehicle: &Vehicle, frame: &Frame<'_>) -> bool {
    let header = frame.header();
    header.system == vehicle.system && header.component == vehicle.component
}
