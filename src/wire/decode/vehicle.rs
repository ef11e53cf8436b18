//! The vehicle whose messages are decoded.

use super::source::Source;
use crate::autopilot::{Autopilot, VehicleKind};
use crate::wire::frame::{ComponentId, SystemId};
use crate::wire::stamped::Record;

/// MAV_AUTOPILOT_INVALID and MAV_TYPE_GCS: a HEARTBEAT with either is not a vehicle's.
const AUTOPILOT_INVALID: u8 = 8;
const TYPE_GCS: u8 = 6;

/// The vehicle whose messages are decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vehicle {
    /// its system
    pub system: SystemId,
    /// its autopilot's component; other components of the system are not listened to
    pub component: ComponentId,
    /// which software
    pub autopilot: Autopilot,
    /// what kind of vehicle, where its HEARTBEAT says so
    pub kind: Option<VehicleKind>,
}

impl Vehicle {
    /// The vehicle that a frame's HEARTBEAT is of; `None` for other messages and for ground stations.
    #[must_use]
    pub fn from_heartbeat(record: &Record<'_>) -> Option<Self> {
        let header = record.frame.header();
        if header.message_id != Source::Heartbeat.message_id() {
            return None;
        }
        let payload = record.frame.payload();
        let (kind, autopilot) = (payload.u8(4), payload.u8(5));
        (autopilot != AUTOPILOT_INVALID && kind != TYPE_GCS).then_some(Self {
            system: header.system,
            component: header.component,
            autopilot: Autopilot::of_heartbeat(autopilot),
            kind: VehicleKind::of_mav_type(kind),
        })
    }
}
