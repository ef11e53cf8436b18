//! One way through a telemetry log.

use std::collections::BTreeSet;

use super::reader::TlogReader;
use super::report::TlogReport;
use super::survey::Survey;
use crate::log::error::LogError;
use crate::log::format::{Place, Sink};
use crate::log::input::Input;
use crate::recording::Event;
use crate::wire::{Decoder, Record, Source, SystemId, Vehicle};

/// What a walk through a telemetry log met beside the samples.
pub(super) struct Walk {
    /// whose messages were decoded
    pub vehicle: Vehicle,
    /// all systems that sent a vehicle's HEARTBEAT, and the one decoded
    pub vehicles: BTreeSet<SystemId>,
    /// what was met while reading it
    pub report: TlogReport,
}

/// Decodes the messages of one vehicle: the chosen one, else the first that sends a HEARTBEAT. Gives each event with its
/// place to `sink`; memory does not grow with the log.
pub(super) fn walk(
    input: &Input<'_>,
    chosen: Option<SystemId>,
    sink: &mut Sink<'_>,
) -> Result<Walk, LogError> {
    let Survey { vehicle, anchor, start_us } = Survey::of(TlogReader::new(input.open()?), chosen)?;
    let mut decoder = Decoder::new(vehicle, anchor, start_us);
    let mut reader = TlogReader::new(input.open()?);
    let mut vehicles = BTreeSet::from([vehicle.system]);
    let mut place = Place::default();
    sink(place, Event::Autopilot(vehicle.autopilot));
    while let Some(record) = reader.next_record()? {
        place = place_of(&record);
        decoder.decode(&record, &mut |event: Event<'_>| sink(place, event));
        if record.known {
            vehicles.extend(Vehicle::from_heartbeat(&record).map(|vehicle| vehicle.system));
        }
    }
    decoder.finish(&mut |event: Event<'_>| sink(place, event));
    let mut report = reader.into_report();
    report.decode = decoder.report().clone();
    Ok(Walk { vehicle, vehicles, report })
}

fn place_of(record: &Record<'_>) -> Place {
    let source = Source::from_message_id(record.frame.header().message_id);
    let independent = source.is_some_and(Source::has_own_time);
    Place { offset: record.offset, arrival_us: independent.then_some(record.stamp_us) }
}
