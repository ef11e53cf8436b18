//! From a file to a recording.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

use super::builder::RecordingBuilder;
use super::clock::Anchor;
use super::decode::{Decoder, Event, Source, Vehicle};
use super::error::LogError;
use super::frame::{ComponentId, SystemId};
use super::recording::{Autopilot, Recording};
use super::report::ReadReport;
use super::tlog::{Record, TlogReader};

/// The component that autopilots use, where no HEARTBEAT says otherwise.
const AUTOPILOT_COMPONENT: ComponentId = ComponentId(1);

/// What to read from a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// the vehicle; needed where the log holds more than one
    pub system: Option<SystemId>,
}

/// A flight, and what was met while reading it.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// the flight
    pub recording: Recording,
    /// what was met while reading it
    pub report: ReadReport,
}

/// Reads a log into memory. The name's extension tells its format.
///
/// # Errors
/// The file cannot be read, is not what its name says, or holds no vehicle or several.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LogError> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("tlog") => load_tlog(path, options),
        _ => Err(LogError::UnknownFormat { path: path.to_owned() }),
    }
}

fn load_tlog(path: &Path, options: &LoadOptions) -> Result<Loaded, LogError> {
    let mut builder = RecordingBuilder::new();
    let (vehicle, mut report) = stream_tlog(path, options, &mut |event| builder.add(event))?;
    let (recording, repairs) = builder.finish(&vehicle);
    report.streams = repairs;
    Ok(Loaded { recording, report })
}

/// Reads a telemetry log, giving each sample to `sink` as it comes; memory does not grow with the log.
///
/// # Errors
/// As [`load`].
pub fn stream_tlog(
    path: &Path,
    options: &LoadOptions,
    sink: &mut impl FnMut(Event<'_>),
) -> Result<(Vehicle, ReadReport), LogError> {
    let walk = TlogWalk::open(path, options)?.run(&mut |_, event| sink(event))?;
    if options.system.is_none() && walk.vehicles.len() > 1 {
        return Err(LogError::SeveralVehicles { systems: walk.vehicles.into_iter().collect() });
    }
    Ok((walk.vehicle, walk.report))
}

/// Where in a telemetry log an event was met.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// host's stamp of the frame, microseconds since 1970 UTC
    pub host_us: u64,
    /// byte offset of the frame in the file
    pub offset: u64,
}

/// What a walk through a telemetry log met beside the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Walk {
    /// whose messages were decoded
    pub vehicle: Vehicle,
    /// all systems that sent a vehicle's HEARTBEAT, and the one decoded
    pub vehicles: BTreeSet<SystemId>,
    /// what was met while reading it
    pub report: ReadReport,
}

/// A telemetry log about to be walked through.
#[derive(Debug)]
pub struct TlogWalk {
    decoder: Decoder,
    reader: TlogReader<File>,
    start_us: u64,
}

impl TlogWalk {
    /// Finds the vehicle and its clock: the chosen one, else the first that sends a HEARTBEAT.
    ///
    /// # Errors
    /// As [`load`], but for several vehicles.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, LogError> {
        let survey = Survey::of(TlogReader::new(open(path)?), options)?;
        let decoder = Decoder::new(survey.vehicle, survey.anchor, survey.start_us);
        Ok(Self { decoder, reader: TlogReader::new(open(path)?), start_us: survey.start_us })
    }

    /// Whose messages will be decoded.
    #[must_use]
    pub fn vehicle(&self) -> Vehicle {
        *self.decoder.vehicle()
    }

    /// Gives each event with its place to `sink`; memory does not grow with the log.
    ///
    /// # Errors
    /// Reading fails.
    pub fn run(mut self, sink: &mut impl FnMut(Place, Event<'_>)) -> Result<Walk, LogError> {
        let vehicle = self.vehicle();
        let mut vehicles = BTreeSet::from([vehicle.system]);
        let mut place = Place { host_us: self.start_us, offset: 0 };
        while let Some(record) = self.reader.next_record()? {
            place = Place { host_us: record.stamp_us, offset: record.offset };
            self.decoder.decode(&record, &mut |event: Event<'_>| sink(place, event));
            vehicles.extend(
                Vehicle::from_heartbeat(&record).filter(|_| record.known).map(|vehicle| vehicle.system),
            );
        }
        self.decoder.finish(&mut |event: Event<'_>| sink(place, event));
        let mut report = self.reader.into_report();
        report.decode = self.decoder.report().clone();
        Ok(Walk { vehicle, vehicles, report })
    }
}

fn open(path: &Path) -> Result<File, LogError> {
    File::open(path).map_err(|source| LogError::Open { path: path.to_owned(), source })
}

/// What must be known before the first sample: whose messages to decode, and where its clock is zero.
struct Survey {
    vehicle: Vehicle,
    anchor: Option<Anchor>,
    start_us: u64,
}

impl Survey {
    /// Reads as far as needed: in a usual log a second or two.
    fn of(mut reader: TlogReader<File>, options: &LoadOptions) -> Result<Self, LogError> {
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
                    .filter(|vehicle| options.system.is_none_or(|wanted| wanted == vehicle.system));
            }
            if !anchors.iter().any(|(known, _)| *known == sender) {
                anchors.extend(anchor(&record).map(|anchor| (sender, anchor)));
            }
            let found = vehicle.and_then(|vehicle| anchor_of(&anchors, &vehicle));
            if let (Some(vehicle), Some(anchor)) = (vehicle, found) {
                return Ok(Self { vehicle, anchor: Some(anchor), start_us: record.stamp_us });
            }
        }
        let vehicle = vehicle.map_or_else(|| silent_vehicle(reader.report(), options), Ok)?;
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
fn silent_vehicle(report: &ReadReport, options: &LoadOptions) -> Result<Vehicle, LogError> {
    let speaking: BTreeSet<SystemId> = report.senders.iter().map(|sender| sender.system).collect();
    let systems = || speaking.iter().copied().collect();
    let Some(system) = options.system else { return Err(LogError::NoVehicle { systems: systems() }) };
    if !speaking.contains(&system) {
        return Err(LogError::SystemAbsent { wanted: system, systems: systems() });
    }
    Ok(Vehicle { system, component: AUTOPILOT_COMPONENT, autopilot: Autopilot::Unknown })
}
