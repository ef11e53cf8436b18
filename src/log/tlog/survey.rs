//! What must be known of a telemetry log before its first sample.

use std::collections::BTreeSet;
use std::io::Read;

use super::reader::TlogReader;
use super::report::TlogReport;
use crate::autopilot::Autopilot;
use crate::log::error::LogError;
use crate::wire::{Anchor, ComponentId, Record, Source, SystemId, Vehicle};

/// The component that autopilots use, where no HEARTBEAT says otherwise.
const AUTOPILOT_COMPONENT: ComponentId = ComponentId(1);

/// Whose messages to decode, and where its clock is zero.
pub(super) struct Survey {
    pub vehicle: Vehicle,
    pub anchor: Option<Anchor>,
    pub start_us: u64,
}

impl Survey {
    /// Reads as far as needed: in a usual log a second or two. The vehicle is the chosen one, else the first that sends a
    /// HEARTBEAT.
    pub(super) fn of(mut reader: TlogReader<impl Read>, chosen: Option<SystemId>) -> Result<Self, LogError> {
        let mut vehicle = None;
        let mut anchors: Vec<((SystemId, ComponentId), Anchor)> = Vec::new();
        let mut start_us = None;
        while let Some(record) = reader.next_record()? {
            start_us.get_or_insert(record.stamp_us);
            if !record.known {
                continue;
            }
            let header = record.frame.header();
            let sender = (header.system, header.component);
            if vehicle.is_none() {
                vehicle = Vehicle::from_heartbeat(&record)
                    .filter(|vehicle| chosen.is_none_or(|wanted| wanted == vehicle.system));
            }
            if !anchors.iter().any(|(known, _)| *known == sender) {
                anchors.extend(anchor(&record).map(|anchor| (sender, anchor)));
            }
            let found = vehicle.and_then(|vehicle| anchor_of(&anchors, &vehicle));
            if let (Some(vehicle), Some(anchor)) = (vehicle, found) {
                return Ok(Self { vehicle, anchor: Some(anchor), start_us: record.stamp_us });
            }
        }
        let vehicle = vehicle.map_or_else(|| silent_vehicle(reader.report(), chosen), Ok)?;
        let anchor = anchor_of(&anchors, &vehicle);
        Ok(Self { vehicle, anchor, start_us: start_us.unwrap_or(0) })
    }
}

fn anchor(record: &Record<'_>) -> Option<Anchor> {
    let source = Source::from_message_id(record.frame.header().message_id)?;
    Anchor::new(source.stamp(record.frame.payload()), i64::try_from(record.stamp_us).ok()?)
}

fn anchor_of(anchors: &[((SystemId, ComponentId), Anchor)], vehicle: &Vehicle) -> Option<Anchor> {
    let sender = (vehicle.system, vehicle.component);
    anchors.iter().find(|(known, _)| *known == sender).map(|(_, anchor)| *anchor)
}

/// A chosen system may be read without a HEARTBEAT, as long as it speaks.
fn silent_vehicle(report: &TlogReport, chosen: Option<SystemId>) -> Result<Vehicle, LogError> {
    let speaking: BTreeSet<SystemId> = report.senders.iter().map(|sender| sender.system).collect();
    let systems = || speaking.iter().copied().collect();
    let Some(system) = chosen else { return Err(LogError::NoVehicle { systems: systems() }) };
    if !speaking.contains(&system) {
        return Err(LogError::SystemAbsent { requested: system, systems: systems() });
    }
    Ok(Vehicle { system, component: AUTOPILOT_COMPONENT, autopilot: Autopilot::Unknown, kind: None })
}
