//! Whom a message is from.

use crate::wire::{Frame, Vehicle};

/// The frame comes from the vehicle's autopilot.
pub(super) fn is_from(vehicle: &Vehicle, frame: &Frame<'_>) -> bool {
    let header = frame.header();
    header.system == vehicle.system && header.component == vehicle.component
}
