//! Walks through a log once and collects everything.

use std::path::Path;
use std::sync::mpsc::sync_channel;

use super::assess::{Assessment, Assessor};
use super::clock::ClockTally;
use super::inspection::{Inspection, Reading, Text, TextSummary, VehicleSummary};
use super::outlook::{Evidence, outlook};
use super::parameters::Parameters;
use super::reading::{csv_reading, tlog_reading};
use super::streams::{StreamTallies, summary_of};
use super::timeline::TimelineTally;
use super::verdict::verdict;
use super::window::{WindowRecorder, windows_of};
use crate::autopilot::Autopilot;
use crate::log::csv::CsvReport;
use crate::log::{LoadOptions, LogError, Place, TlogWalk, Walk, who_flew};
use crate::recording::{Recording, StreamKey, StreamStats};
use crate::vehicle::Vehicle;
use crate::wire::Event;

/// MAV_SEVERITY_WARNING; smaller is worse.
const WARNING: u8 = 4;
/// Warnings kept; further ones are counted.
const KEPT_WARNINGS: usize = 200;
/// Events between two calls of the progress function.
const PROGRESS_EVENTS: u32 = 1 << 16;

/// What is collected of a log beside its windows.
#[derive(Debug, Default)]
struct Tally {
    streams: StreamTallies,
    clock: ClockTally,
    timeline: TimelineTally,
    parameters: Parameters,
    texts: TextSummary,
}

impl Tally {
    /// Takes an event; says whether it changes a parameter that identification reads.
    fn add(&mut self, place: Place, event: &Event<'_>) -> bool {
        self.clock.add(place, event);
        match *event {
            Event::Sample { stream, time_s, values } => {
                self.streams.add(stream, time_s, values);
                self.timeline.add(stream.quantity, time_s, values);
            }
            Event::Parameter { name, value } => return self.parameters.take(name, value),
            Event::Text { time_s, severity, text } => self.text(time_s, severity, text),
            Event::ClockReset { time_s, .. } => {
                self.streams.reset();
                self.timeline.reset(time_s);
            }
            Event::EstimatorReset { .. } => {}
        }
        false
    }

    fn text(&mut self, time_s: f64, severity: u8, text: &str) {
        self.texts.count += 1;
        if severity <= WARNING {
            self.texts.warning_count += 1;
            if self.texts.warnings.len() < KEPT_WARNINGS {
                self.texts.warnings.push(Text { time_s, severity, text: text.to_owned() });
            }
        }
    }
}

/// What a telemetry log holds, in memory that does not grow with it. Without a HEARTBEAT the system with the smallest
/// number is taken, of several vehicles the one that flew and where several did the first, unless `options` choose one.
/// `progress` is told the bytes read so far.
///
/// # Errors
/// The log cannot be read, or the chosen system does not speak in it.
pub fn inspect_tlog(
    path: &Path,
    options: &LoadOptions,
    vehicle: Option<&Vehicle>,
    progress: &mut dyn FnMut(u64),
) -> Result<Inspection, LogError> {
    let mut options = *options;
    if let Err(refusal) = TlogWalk::open(path, &options) {
        match refusal {
            LogError::NoVehicle { ref systems } if options.system.is_none() && !systems.is_empty() => {
                options.system = systems.first().copied();
            }
            refusal => return Err(refusal),
        }
    }
    let mut first = Pass::run(path, &options, (vehicle, Parameters::default()), progress)?;
    if options.system.is_none() && first.walk.vehicles.len() > 1 {
        match who_flew(path) {
            Ok(system) if system != first.walk.vehicle.system => {
                options.system = Some(system);
                first = Pass::run(path, &options, (vehicle, Parameters::default()), progress)?;
            }
            // the first is as good as any
            Ok(_) | Err(LogError::SeveralVehicles { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    // commands become thrust by the autopilot's parameters: windows before they came are looked at again
    let pass = if first.parameters_late && vehicle.is_some() {
        Pass::run(path, &options, (vehicle, first.tally.parameters), progress)?
    } else {
        first
    };
    Ok(pass.inspection(vehicle))
}

/// Once through a telemetry log.
struct Pass {
    tally: Tally,
    assessment: Assessment,
    walk: Walk,
    /// a parameter that matters changed after a window had been looked at
    parameters_late: bool,
    numbers_held_max: usize,
}

impl Pass {
    fn run(
        path: &Path,
        options: &LoadOptions,
        (vehicle, parameters): (Option<&Vehicle>, Parameters),
        progress: &mut dyn FnMut(u64),
    ) -> Result<Self, LogError> {
        let walk = TlogWalk::open(path, options)?;
        let mut recorder = WindowRecorder::new(walk.vehicle());
        let mut tally = Tally { parameters, ..Tally::default() };
        let (mut parameters_late, mut windows, mut events) = (false, 0_usize, 0_u32);
        // a window is assessed while the next one is read; the channel holds none, so at most two exist
        std::thread::scope(|scope| {
            let (finished, to_assess) = sync_channel::<Recording>(0);
            let worker = scope.spawn(move || {
                let mut assessor = Assessor::new(vehicle);
                to_assess.iter().for_each(|window| assessor.window(&window));
                assessor.finish()
            });
            let mut send = |window: Option<Recording>, parameters: &Parameters| {
                if let Some(mut window) = window {
                    window.parameters.clone_from(parameters.values());
                    // fails only where the worker has ended, and then joining it says why
                    let _ = finished.send(window);
                    windows += 1;
                }
                windows
            };
            let walked = walk.run(&mut |place, event| {
                let changed = tally.add(place, &event);
                let sent = send(recorder.add(event), &tally.parameters);
                parameters_late |= changed && sent > 0;
                events = events.wrapping_add(1);
                if events.is_multiple_of(PROGRESS_EVENTS) {
                    progress(place.offset);
                }
            });
            send(recorder.close(), &tally.parameters);
            drop(finished);
            let assessment = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            Ok(Self {
                tally,
                assessment,
                walk: walked?,
                parameters_late,
                numbers_held_max: recorder.numbers_max(),
            })
        })
    }

    fn inspection(self, vehicle: Option<&Vehicle>) -> Inspection {
        let Walk { vehicle: speaker, vehicles, report } = self.walk;
        let reading = tlog_reading(&report);
        let heartbeats = report
            .senders
            .iter()
            .filter(|sender| sender.system == speaker.system && sender.component == speaker.component)
            .map(|sender| sender.messages.get(crate::wire::Source::Heartbeat.message_id()))
            .sum::<u64>();
        let streams = self.tally.streams.summary();
        let found = Found {
            vehicle: VehicleSummary {
                system: Some(speaker.system.0),
                component: Some(speaker.component.0),
                autopilot: speaker.autopilot.id(),
                others: vehicles.iter().filter(|s| **s != speaker.system).map(|s| s.0).collect(),
                without_heartbeat: heartbeats == 0,
            },
            autopilot: speaker.autopilot,
            reading: Reading::Tlog(Box::new(reading)),
            losses: report.losses(),
            streams,
            numbers_held_max: self.numbers_held_max,
        };
        found.inspection(self.tally, self.assessment, vehicle)
    }
}

/// What a recording that is in memory holds.
#[must_use]
pub fn inspect_csv(recording: &Recording, report: &CsvReport, vehicle: Option<&Vehicle>) -> Inspection {
    let mut tally = Tally::default();
    let mut streams = Vec::new();
    for (key, stream) in &recording.streams {
        for index in 0..stream.len() {
            tally.timeline.add(key.quantity, stream.time_s[index], stream.sample(index));
        }
        stream.time_s.first().iter().chain(&stream.time_s.last()).for_each(|t| tally.clock.cover(**t));
        streams.push((*key, stream.width, StreamStats::of(stream)));
    }
    recording.clock_resets_s.iter().for_each(|time_s| tally.clock.reset(*time_s));
    let mut assessor = Assessor::new(vehicle);
    windows_of(recording).for_each(|window| assessor.window(&window));
    let found = Found {
        vehicle: VehicleSummary { autopilot: recording.autopilot.id(), ..VehicleSummary::default() },
        autopilot: recording.autopilot,
        losses: report.losses(),
        reading: Reading::Csv(csv_reading(report)),
        streams,
        numbers_held_max: recording.streams.values().map(|s| s.values.len() + s.len()).sum(),
    };
    found.inspection(tally, assessor.finish(), vehicle)
}

/// What either kind of file gives.
struct Found {
    vehicle: VehicleSummary,
    autopilot: Autopilot,
    reading: Reading,
    losses: Vec<String>,
    streams: Vec<(StreamKey, usize, StreamStats)>,
    numbers_held_max: usize,
}

impl Found {
    fn inspection(self, tally: Tally, assessment: Assessment, vehicle: Option<&Vehicle>) -> Inspection {
        let missing_curve = tally.parameters.missing_curve(self.autopilot);
        let evidence = Evidence { streams: &self.streams, assessment: &assessment, vehicle, missing_curve };
        let identifiability = outlook(&evidence);
        let (verdict, advice) = verdict(&evidence, &identifiability, &self.vehicle);
        Inspection {
            verdict,
            advice,
            vehicle: self.vehicle,
            clock: tally.clock.summary(),
            reading: self.reading,
            losses: self.losses,
            streams: self.streams.iter().map(summary_of).collect(),
            timeline: tally.timeline.summary(self.autopilot),
            flight: assessment.flight,
            excitation: assessment.excitation,
            stream_offsets: assessment.offsets,
            identifiability,
            parameters: tally.parameters.summary(),
            texts: tally.texts,
            numbers_held_max: self.numbers_held_max,
        }
    }
}
