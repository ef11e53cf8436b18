//! Walks through a log once and collects everything.

use super::assess::{Assessment, Assessor};
use super::clock::ClockTally;
use super::evidence::Evidence;
use super::flown::FlightSummary;
use super::forecast::{Forecast, forecast};
use super::inspection::{Inspection, Reading, Text, TextSummary, Timeline, VehicleSummary};
use super::outlook::outlook;
use super::parameters::Parameters;
use super::quantities::{Outcome, quantities};
use super::reading::{reading_of, vehicle_of};
use super::streams::{StreamTallies, is_disordered, summary_of};
use super::timeline::TimelineTally;
use super::verdict::{unflown, verdict};
use super::window::{WindowRecorder, windows_of};
use crate::autopilot::{Autopilot, VehicleKind};
use crate::log::{self, Input, LogError, OpenOptions, Opened, Place, ReadReport};
use crate::recording::{Event, Recording, StreamKey, StreamStats};
use crate::signals::{OffMixer, SignalsError};
use crate::vehicle::Vehicle;
use crate::wire::SystemId;
use std::sync::mpsc::sync_channel;

/// A window holds all of a flight where no more than this times its seconds can be used. Only the words "at most" depend on it.
const MOSTLY: f64 = 1.05;
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
    autopilot: Autopilot,
}

impl Tally {
    /// Takes an event; says whether it changes a parameter that identification reads.
    fn add(&mut self, place: Place, event: &Event<'_>) -> bool {
        self.clock.add(place, event);
        match *event {
            Event::Autopilot(autopilot) => self.autopilot = autopilot,
            Event::Sample { stream, time_s, values } => {
                self.streams.add(stream, time_s, values);
                self.timeline.add(stream.quantity, time_s, values);
                self.parameters.at(time_s);
            }
            Event::Parameter { name, value } => return self.parameters.take(name, value),
            Event::ParameterDefault { name, value } => return self.parameters.take_default(name, value),
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

/// What a log holds, in memory that does not grow with it but for a table. Of a telemetry log without a HEARTBEAT the
/// system with the smallest number is taken, of several vehicles the one that flew and where several did the first, unless
/// `options` choose one. `progress` is told the bytes read so far.
///
/// # Errors
/// The log cannot be read, is of no known format, or the chosen system does not speak in it.
pub fn inspect<'a>(
    log: impl Into<Input<'a>>,
    options: &OpenOptions,
    vehicle: Option<&Vehicle>,
    progress: &mut dyn FnMut(u64),
) -> Result<Inspection, LogError> {
    let input = log.into();
    // the rows of a table may come in any order
    if log::format_of(input)?.takes_columns {
        return Ok(inspect_recording(&log::open(input, options)?, vehicle));
    }
    let mut options = options.clone();
    let mut first = Pass::run(input, &options, (vehicle, Parameters::default(), false), progress);
    if let Some(system) = first.as_ref().err().and_then(instead).filter(|_| options.system.is_none()) {
        options.system = Some(system);
        first = Pass::run(input, &options, (vehicle, Parameters::default(), false), progress);
    }
    let first = first?;
    if is_disordered(&first.tally.streams.summary()) {
        // windows need the order of time
        return Ok(inspect_recording(&log::open(input, &options)?, vehicle));
    }
    // commands become thrust by the autopilot's parameters: windows before they came are looked at again; and all of them
    // where the log turns out to be damaged
    let is_damaged = first.report.is_damaged();
    let pass = if first.parameters_late && vehicle.is_some() || is_damaged {
        Pass::run(input, &options, (vehicle, first.tally.parameters.read_again(), is_damaged), progress)?
    } else {
        first
    };
    Ok(pass.inspection(vehicle))
}

/// The system that is looked at where a log does not say by itself which one is meant.
fn instead(refusal: &LogError) -> Option<SystemId> {
    match refusal {
        LogError::OtherFlew { system } => Some(*system),
        LogError::NoVehicle { systems } => systems.first().copied(),
        // the first is as good as any
        LogError::SeveralVehicles { first, .. } => Some(*first),
        _ => None,
    }
}

/// Once through a log.
struct Pass {
    tally: Tally,
    assessment: Assessment,
    report: ReadReport,
    /// a parameter that matters changed after a window had been looked at
    parameters_late: bool,
    numbers_held_max: usize,
}

impl Pass {
    fn run(
        input: Input<'_>,
        options: &OpenOptions,
        (vehicle, parameters, is_damaged): (Option<&Vehicle>, Parameters, bool),
        progress: &mut dyn FnMut(u64),
    ) -> Result<Self, LogError> {
        let mut recorder = WindowRecorder::new(is_damaged);
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
            let read = log::stream(input, options, &mut |place, event| {
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
            let mut report = read?;
            report.losses.extend(recorder.losses());
            Ok(Self { tally, assessment, report, parameters_late, numbers_held_max: recorder.numbers_max() })
        })
    }

    fn inspection(self, vehicle: Option<&Vehicle>) -> Inspection {
        let found = Found {
            vehicle: vehicle_of(&self.report, self.tally.autopilot),
            autopilot: self.tally.autopilot,
            reading: reading_of(&self.report),
            losses: self.report.losses.iter().map(ToString::to_string).collect(),
            streams: self.tally.streams.summary(),
            numbers_held_max: self.numbers_held_max,
            kind: self.report.kind(),
            unreadable: self.report.unreadable(),
            timed: self.report.is_timed(),
            untimed_outputs: self.report.has_untimed_outputs(),
            undefined: self.report.lacks_definitions(),
            ends_early: self.report.ends_early(),
            steps_back: self.report.out_of_order(),
            damage: self.report.damage(),
            is_onboard: self.report.onboard().is_some(),
            start_utc_us: self.report.onboard().and_then(|onboard| onboard.start_utc_us),
        };
        found.inspection(self.tally, self.assessment, vehicle)
    }
}

/// What a recording that is in memory holds.
#[must_use]
pub fn inspect_recording(opened: &Opened, vehicle: Option<&Vehicle>) -> Inspection {
    let Opened { recording, report } = opened;
    let mut tally = Tally::default();
    let mut streams = Vec::new();
    for (key, stream) in &recording.streams {
        for index in 0..stream.len() {
            tally.timeline.add(key.quantity, stream.time_s[index], stream.sample(index));
        }
        stream.time_s.first().iter().chain(&stream.time_s.last()).for_each(|t| tally.clock.cover(**t));
        streams.push((*key, stream.width, StreamStats::of(stream)));
    }
    recording.parameters.iter().for_each(|(name, value)| {
        tally.parameters.take(name, *value);
    });
    recording.clock_resets_s.iter().for_each(|time_s| tally.clock.reset(*time_s));
    let mut assessor = Assessor::new(vehicle);
    windows_of(recording).for_each(|window| assessor.window(&window));
    let found = Found {
        vehicle: vehicle_of(report, recording.autopilot),
        autopilot: recording.autopilot,
        losses: report.losses.iter().map(ToString::to_string).collect(),
        reading: reading_of(report),
        streams,
        numbers_held_max: recording.streams.values().map(|s| s.values.len() + s.len()).sum(),
        kind: report.kind(),
        unreadable: report.unreadable(),
        timed: report.is_timed(),
        untimed_outputs: report.has_untimed_outputs(),
        undefined: report.lacks_definitions(),
        ends_early: report.ends_early(),
        steps_back: report.out_of_order(),
        damage: report.damage(),
        is_onboard: report.onboard().is_some(),
        start_utc_us: report.onboard().and_then(|onboard| onboard.start_utc_us),
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
    /// what kind of vehicle
    kind: Option<VehicleKind>,
    /// messages that cannot be read, where they are many
    unreadable: Option<u64>,
    /// messages carry times
    timed: bool,
    /// motor outputs carry none
    untimed_outputs: bool,
    /// most of its messages are not defined in it
    undefined: bool,
    /// it ends before the first of them
    ends_early: bool,
    /// steps back of its stamps, where its messages stand in another order than they were written in
    steps_back: Option<u64>,
    /// how much of it is damaged, in words, where streams may be gone with it
    damage: Option<String>,
    /// the vehicle wrote it
    is_onboard: bool,
    /// when it began, as a satellite receiver says
    start_utc_us: Option<u64>,
}

impl Found {
    /// What the liveliest window would tell. What refuses all of a log without a vehicle is noted as with one.
    fn foreseen(
        &self,
        tally: &Tally,
        assessment: &mut Assessment,
        vehicle: Option<&Vehicle>,
    ) -> Option<Forecast> {
        let is_multirotor = self.kind.is_none_or(|kind| kind == VehicleKind::Multirotor);
        let (_, window) = assessment.liveliest.as_mut().filter(|_| is_multirotor)?;
        window.parameters.clone_from(tally.parameters.values());
        match forecast(window, vehicle) {
            Ok(foreseen) => Some(foreseen),
            Err(Some(slow @ SignalsError::TooSlow { .. })) if vehicle.is_none() => {
                assessment.refusal = Some(slow);
                None
            }
            Err(_) => None,
        }
    }

    /// Of which kind of vehicle it is, and the parameters as they stood in the air. Returns the spans of flight, s.
    fn conclude(&mut self, tally: &mut Tally, assessment: &mut Assessment) -> Vec<(f64, f64)> {
        let flown_s: Vec<(f64, f64)> =
            assessment.flight.segments.iter().map(|segment| (segment.start_s, segment.end_s)).collect();
        tally.parameters.keep_airborne(self.autopilot, &flown_s);
        self.kind =
            self.kind.map(|kind| kind.by_parameters(|name| tally.parameters.values().get(name).copied()));
        self.vehicle.kind = self.kind.map(VehicleKind::name);
        if self.kind.is_some_and(|kind| !kind.flies()) {
            assessment.flight = FlightSummary::on_the_ground();
        }
        if self.kind.is_some_and(|kind| kind != VehicleKind::Multirotor) {
            assessment.leave_outputs_untold();
        }
        if self.steps_back.is_some() {
            // then no time in the air is known
            assessment.flight = FlightSummary::out_of_order();
        }
        flown_s
    }

    /// Whose names of modes hold: those of ArduPilot's planes are others than a multirotor's of the same number, PX4's are of all.
    fn modes_of(&self) -> Autopilot {
        let rotors = [VehicleKind::Multirotor, VehicleKind::Helicopter];
        let is_known =
            self.autopilot == Autopilot::Px4 || self.kind.is_none_or(|kind| rotors.contains(&kind));
        if is_known { self.autopilot } else { Autopilot::Unknown }
    }

    fn inspection(
        mut self,
        mut tally: Tally,
        mut assessment: Assessment,
        vehicle: Option<&Vehicle>,
    ) -> Inspection {
        if self.ends_early && self.losses.is_empty() {
            self.losses
                .push("all behind its first messages: it was cut off before its first sample".to_owned());
        }
        let flown_s = self.conclude(&mut tally, &mut assessment);
        let mut clock = std::mem::take(&mut tally.clock).summary();
        clock.start_utc_us = clock.start_utc_us.or(self.start_utc_us);
        let modes = self.modes_of();
        let foreseen = self.foreseen(&tally, &mut assessment, vehicle);
        let parameter = |name: &str| tally.parameters.values().get(name).copied();
        let logging = self.autopilot.stack().map(|stack| stack.logging_by(parameter));
        let evidence = Evidence {
            streams: &self.streams,
            assessment: &assessment,
            vehicle,
            assumed: foreseen.as_ref().and_then(Forecast::assumed),
            contradictions: foreseen.as_ref().map_or(&[], |foreseen| &foreseen.contradictions),
            missing_curve: tally.parameters.missing_curve(self.autopilot),
            kind: self.kind,
            armed: tally.timeline.armed_ever(),
            said_in_air_s: tally.timeline.said_in_air_s(),
            steps_back: self.steps_back,
            unreadable: self.unreadable,
            timed: self.timed,
            untimed_outputs: self.untimed_outputs,
            undefined: self.undefined,
            ends_early: self.ends_early,
            damage: self.damage.as_deref(),
            logging: logging.as_deref().filter(|_| self.is_onboard),
            own_log: logging.as_deref(),
        };
        let identifiability = outlook(&evidence);
        let most_s = assessment.liveliest.as_ref().map_or(0.0, |(usable_s, _)| *usable_s);
        let quantities = quantities(&Outcome {
            evidence: &evidence,
            body: &identifiability,
            foreseen: foreseen.as_ref(),
            at_most: assessment.flight.usable_s > MOSTLY * most_s,
        });
        let (verdict, mut advice) = verdict(&evidence, &identifiability, &self.vehicle);
        advice.splice(0..0, assessment.off_mixer.iter().map(OffMixer::advice));
        if !evidence.is_of_other_kind() {
            advice.extend(tally.parameters.notes(self.autopilot, &flown_s).iter().map(ToString::to_string));
        }
        Inspection {
            verdict,
            unflown: unflown(&evidence),
            other_rotors: evidence.other_rotors(),
            advice,
            vehicle: self.vehicle,
            clock,
            reading: self.reading,
            losses: self.losses,
            streams: self.streams.iter().map(summary_of).collect(),
            timeline: if self.timed { tally.timeline.summary(modes) } else { Timeline::default() },
            flight: assessment.flight,
            outputs_off_mixer: assessment.off_mixer,
            excitation: assessment.excitation,
            stream_offsets: assessment.offsets,
            quantities,
            quantities_relative: foreseen.is_some_and(|foreseen| foreseen.assumed),
            identifiability,
            parameters: tally.parameters.summary(),
            texts: tally.texts,
            numbers_held_max: self.numbers_held_max,
        }
    }
}
