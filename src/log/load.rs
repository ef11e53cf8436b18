//! From a file to a recording.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

use super::builder::RecordingBuilder;
use super::error::LogError;
use super::flights::{Cells, Flights, Hold, Plan, is_state};
use super::flown::who_flew;
use super::report::ReadReport;
use super::tlog::TlogReader;
use crate::autopilot::Autopilot;
use crate::recording::Recording;
use crate::wire::{Anchor, ComponentId, Decoder, Event, Record, Source, SystemId, Vehicle};

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

/// Reads a log into memory, all of it. The name's extension tells its format. Of several vehicles, the one that flew is
/// read, unless `options` choose one.
///
/// ```
/// use mavid::log::{LoadOptions, load};
/// use mavid::recording::Quantity;
/// use std::path::Path;
///
/// let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p04_identify_10_22s.tlog");
/// let log = load(&path, &LoadOptions::default())?;
/// let attitude = log.recording.streams.iter().find(|(key, _)| key.quantity == Quantity::Attitude);
/// assert!(attitude.is_some_and(|(_, stream)| stream.len() > 100));
/// # Ok::<(), mavid::log::LogError>(())
/// ```
///
/// # Errors
/// The file cannot be read, is not what its name says, holds no vehicle, or several that flew.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LogError> {
    is_tlog(path)?;
    load_tlog(path, options)
}

fn is_tlog(path: &Path) -> Result<(), LogError> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some(extension) if extension.eq_ignore_ascii_case("tlog") => Ok(()),
        _ => Err(LogError::UnknownFormat { path: path.to_owned() }),
    }
}

fn load_tlog(path: &Path, options: &LoadOptions) -> Result<Loaded, LogError> {
    let read = |options: &LoadOptions| {
        let mut builder = RecordingBuilder::new();
        let walk = TlogWalk::open(path, options)?.run(&mut |_, event| builder.add(event))?;
        Ok::<_, LogError>((walk, builder))
    };
    let (mut walk, builder) = of_the_flown(path, options, read)?;
    let (recording, repairs) = builder.finish(&walk.vehicle);
    walk.report.streams = repairs;
    Ok(Loaded { recording, report: walk.report })
}

/// Reads a log; where it holds several vehicles and none is chosen, the one that flew.
pub(super) fn of_the_flown<T>(
    path: &Path,
    options: &LoadOptions,
    read: impl Fn(&LoadOptions) -> Result<(Walk, T), LogError>,
) -> Result<(Walk, T), LogError> {
    let (walk, found) = read(options)?;
    if options.system.is_some() || walk.vehicles.len() < 2 {
        return Ok((walk, found));
    }
    let system = who_flew(path)?;
    if system == walk.vehicle.system {
        return Ok((walk, found));
    }
    drop(found);
    read(&LoadOptions { system: Some(system) })
}

/// The flights of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedFlights {
    /// the flights
    pub flights: Flights,
    /// what was met while reading the log
    pub report: ReadReport,
    /// the vehicle that was read
    pub vehicle: Vehicle,
    /// others that sent a vehicle's HEARTBEAT
    pub others: Vec<SystemId>,
}

/// Reads a log's flights into memory that does not grow with its length, at most `most`: see [`Flights::of`]. The name's extension tells
/// its format. Of several vehicles, the one that flew is read, unless `options` choose one.
///
/// # Errors
/// As [`load`].
pub fn load_flights(path: &Path, options: &LoadOptions, most: &Hold) -> Result<LoadedFlights, LogError> {
    is_tlog(path)?;
    let read = |options: &LoadOptions| {
        let mut cells = Cells::default();
        let mut builder = Some(RecordingBuilder::new());
        let walk = TlogWalk::open(path, options)?.run(&mut |_, event| {
            cells.add(&event);
            // too much to be held: what is kept of it is read once more
            if builder.as_ref().is_some_and(|builder| builder.numbers() > most.numbers) {
                builder = None;
            }
            if let Some(builder) = &mut builder {
                builder.add(event);
            }
        })?;
        Ok::<_, LogError>((walk, (cells, builder)))
    };
    let (mut walk, (cells, builder)) = of_the_flown(path, options, read)?;
    let (plan, options) = (cells.plan(most), LoadOptions { system: Some(walk.vehicle.system) });
    let builder = match (builder, &plan) {
        (Some(builder), _) => builder,
        (None, Some(plan)) => within(path, &options, Some(plan))?,
        // it fits in, but for what stands empty where a stream grows wider
        (None, None) => within(path, &options, None)?,
    };
    let (recording, repairs) = builder.finish(&walk.vehicle);
    walk.report.streams = repairs;
    Ok(LoadedFlights {
        flights: Flights::by_plan(recording, plan.as_ref()),
        report: walk.report,
        vehicle: walk.vehicle,
        others: walk.vehicles.into_iter().filter(|system| *system != walk.vehicle.system).collect(),
    })
}

/// What a log holds in the spans that are kept; all of it without a plan.
fn within(path: &Path, options: &LoadOptions, plan: Option<&Plan>) -> Result<RecordingBuilder, LogError> {
    let mut builder = RecordingBuilder::new();
    let keeps = |time_s: f64| plan.is_none_or(|plan| plan.keeps(time_s));
    let kept = |event: &Event<'_>| match event {
        Event::Sample { stream, time_s, .. } => is_state(stream.quantity) || keeps(*time_s),
        Event::Text { time_s, .. } => keeps(*time_s),
        Event::Parameter { .. } | Event::ClockReset { .. } | Event::EstimatorReset { .. } => true,
    };
    TlogWalk::open(path, options)?.run(&mut |_, event| {
        if kept(&event) {
            builder.add(event);
        }
    })?;
    Ok(builder)
}

/// Reads a telemetry log, giving each sample to `sink` as it comes; memory does not grow with the log.
///
/// # Errors
/// As [`load`], and where a vehicle flew that is not the first that sends a HEARTBEAT.
pub fn stream_tlog(
    path: &Path,
    options: &LoadOptions,
    sink: &mut impl FnMut(Event<'_>),
) -> Result<(Vehicle, ReadReport), LogError> {
    let walk = TlogWalk::open(path, options)?.run(&mut |_, event| sink(event))?;
    if options.system.is_none() && walk.vehicles.len() > 1 && who_flew(path)? != walk.vehicle.system {
        let systems = walk.vehicles.into_iter().collect();
        return Err(LogError::SeveralVehicles { flew: true, systems });
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
