//! Flights of logs, whatever their format: read, conditioned, and separated.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::autopilot::VehicleKind;
use crate::config::{ConfigError, load_csv_mapping};
use crate::diagnose::holdout::HeldOut;
use crate::estimate::torque_by_motion;
use crate::log::{
    Format, Hold, LogError, LogFlight, OpenOptions, OpenedFlights, ReadReport, format_of, open_flights,
};
use crate::note::{About, Note};
use crate::recording::{Quantity, Recording};
use crate::signals::{
    ConditionSettings, ReportedState, Signals, adopt_in_flight_parameters, best, off_ground,
    outputs_off_mixer, spans,
};
use crate::text;
use crate::vehicle::Vehicle;
use crate::wire::SystemId;
use rayon::prelude::*;

use super::both_logs::each_flight_once;
use super::flight::{Flight, LoggedBy};
use super::{InputFile, StudyError};

/// Stamps and values of one log that are searched for effects. Memory and time grow with them: a log of an on-board profile holds
/// more of them a second than telemetry.
const SEARCHED: usize = 1_500_000;
/// s of a log that are used however densely it is logged: an identification flight and a half.
const SHORT_S: f64 = 150.0;
/// What is identified of one log.
pub(super) const IDENTIFIED: Hold = Hold { seconds: 1800.0, numbers: SEARCHED, short_s: SHORT_S };
/// What is validated with of one log: no effects are searched.
pub(super) const VALIDATED: Hold = Hold { seconds: 1800.0, numbers: 2 * SEARCHED, short_s: SHORT_S };
/// What is explained of one log.
pub(super) const EXPLAINED: Hold = Hold { seconds: 480.0, numbers: SEARCHED, short_s: SHORT_S };
/// How logs are read.
#[derive(Debug, Clone, Default)]
pub struct ReadSettings {
    /// what the columns of a CSV mean; `None`: the names in `configs/csv/default.toml`
    pub csv_map: Option<PathBuf>,
    /// the vehicle; `None`: the only one of the log that flew
    pub system: Option<SystemId>,
}

impl ReadSettings {
    /// What they mean for the reader.
    ///
    /// # Errors
    /// The mapping of columns cannot be read.
    pub fn open_options(&self) -> Result<OpenOptions, ConfigError> {
        let columns = self.csv_map.as_deref().map(load_csv_mapping).transpose()?.unwrap_or_default();
        Ok(OpenOptions { system: self.system, columns })
    }

    /// A mapping of columns needs a table among the logs, a system a telemetry log. A log that cannot be read may be one: that is told later.
    ///
    /// # Errors
    /// [`StudyError::Setting`] otherwise.
    pub(super) fn check<'a>(
        &self,
        logs: impl Iterator<Item = &'a PathBuf> + Clone,
    ) -> Result<(), StudyError> {
        let has_none =
            |takes: fn(&Format) -> bool| !logs.clone().any(|log| format_of(log).map_or(true, takes));
        let refuse = |name, wanted: &str| {
            let why = format!("expected {wanted} among the logs, got none");
            Err(StudyError::Setting { name, why })
        };
        if self.csv_map.is_some() && has_none(|format| format.takes_columns) {
            return refuse("csv-map", "a .csv");
        }
        if self.system.is_some() && has_none(|format| format.takes_system) {
            return refuse("system-id", "a telemetry log (.tlog)");
        }
        Ok(())
    }
}

/// Flights that are ready for estimation; all have one entry a flight.
#[derive(Debug, Default)]
pub(super) struct Prepared {
    pub(super) recordings: Vec<Recording>,
    pub(super) signals: Vec<Signals>,
    pub(super) inputs: Vec<InputFile>,
    /// seen with the wind: not where the setpoints are; empty: none is
    pub(super) drift: Vec<bool>,
}

impl Prepared {
    pub(super) fn is_empty(&self) -> bool {
        self.signals.is_empty()
    }

    /// Each flight's file and signals.
    pub(super) fn each(&self) -> impl Iterator<Item = (&InputFile, &Signals)> {
        self.inputs.iter().zip(&self.signals)
    }

    /// As flights that a model is shown on.
    pub(super) fn held_out(&self) -> Vec<HeldOut<'_>> {
        let each = self.recordings.iter().zip(&self.signals).zip(&self.inputs);
        let drifts = |place: usize| self.drift.get(place).copied().unwrap_or(false);
        each.enumerate()
            .map(|(place, ((recording, signals), input))| HeldOut {
                name: &input.path,
                signals,
                recording: (!drifts(place)).then_some(recording),
            })
            .collect()
    }
}

/// The flights of every log, read side by side: each has at least one, and at most as much as `most`. A flight that the vehicle
/// and a ground station have logged is one flight.
pub(super) fn load_all(
    logs: &[PathBuf],
    read: &ReadSettings,
    most: &Hold,
) -> Result<Vec<Vec<Flight>>, StudyError> {
    let (flown, refused) = load_each(logs, read, most)?;
    refused.into_iter().next().map_or(Ok(flown), Err)
}

/// The same of the logs in which there is a flight, and why there is none in the others.
pub(super) fn load_each(
    logs: &[PathBuf],
    read: &ReadSettings,
    most: &Hold,
) -> Result<(Vec<Vec<Flight>>, Vec<StudyError>), StudyError> {
    let options = read.open_options()?;
    let done: Vec<_> = logs.par_iter().map(|path| load(path, &options, most)).collect();
    let (mut flown, mut refused) = (Vec::new(), Vec::new());
    for log in done {
        match log {
            Ok(flights) => flown.push(flights),
            Err(error @ StudyError::NoFlight { .. }) => refused.push(error),
            Err(error) => return Err(error),
        }
    }
    Ok((each_flight_once(flown), refused))
}

fn load(path: &Path, options: &OpenOptions, most: &Hold) -> Result<Vec<Flight>, StudyError> {
    let opened = open_flights(path, options, most).map_err(|error| unread(path, error))?;
    refuse_other_kinds(path, &opened)?;
    refuse_no_flight(path, &opened)?;
    let about = || About::File(text::path(&path));
    // what a vehicle still writes after it has disarmed is no part of a flight
    let disarmed = opened.flights.flights.last().is_some_and(|flight| flight.recording.ends_disarmed());
    let (after, losses): (Vec<_>, Vec<_>) =
        opened.report.losses.iter().partition(|loss| disarmed && loss.is_unfinished_record());
    let after = after.into_iter().map(|loss| format!("{loss}, after the vehicle had disarmed"));
    let losses = losses.into_iter().map(ToString::to_string);
    let oddities = opened.report.oddities.iter().map(ToString::to_string);
    let mut input = InputFile::of(path)?;
    input.notes.extend(losses.map(|text| Note::loss(about(), text)));
    input.notes.extend(
        whose(&opened.report)
            .into_iter()
            .chain(oddities)
            .chain(after)
            .map(|text| Note::remark(about(), text)),
    );
    Ok(of_log(opened.flights.flights, &input, &opened.report))
}

/// Nothing but a multirotor is known here.
pub(super) fn refuse_other_kinds(log: &Path, opened: &OpenedFlights) -> Result<(), StudyError> {
    let kind = opened.report.kind().map(|kind| kind.by_parameters(|name| parameter(opened, name)));
    match kind.filter(|kind| *kind != VehicleKind::Multirotor) {
        None => Ok(()),
        Some(kind) => {
            let why = format!("expected the log of a multirotor, got that of a {}", kind.name());
            Err(StudyError::File { file: text::path(&log), why })
        }
    }
}

/// What the log says of a parameter of the vehicle.
fn parameter(opened: &OpenedFlights, name: &str) -> Option<f64> {
    opened.flights.flights.iter().find_map(|flight| flight.recording.parameters.get(name).copied())
}

/// A log that says itself that nothing was flown, or that has no clock, is told so, and not that a stream is missing.
fn refuse_no_flight(path: &Path, opened: &OpenedFlights) -> Result<(), StudyError> {
    let mut flights = opened.flights.flights.iter();
    if let Some(count) = opened.report.out_of_order() {
        let why = format!(
            "expected a log in the order in which it was written, got one whose stamps run back {count} times: it is damaged, or \
             its pieces were put together wrongly; give a sound copy"
        );
        return Err(StudyError::NoFlight { file: text::path(&path), why });
    }
    let why = if opened.report.lacks_definitions() {
        "expected a whole log, got one whose messages are not defined: its beginning is missing"
    } else if !opened.report.is_timed() {
        "expected a log with times, got one whose messages have no time stamps of the vehicle"
    } else if opened.report.ends_early() {
        "expected a whole log, got one that ends before its first sample"
    } else if flights.all(|flight| ReportedState::of(&flight.recording).never_armed()) {
        "expected a flight, got the log of a vehicle that was never armed"
    } else {
        return Ok(());
    };
    Err(StudyError::NoFlight { file: text::path(&path), why: why.to_owned() })
}

/// Why a log cannot be read, with its name.
#[must_use]
pub fn unread(path: &Path, error: LogError) -> StudyError {
    match error {
        // these name it
        LogError::Open { .. } | LogError::Table(_) => StudyError::Log(error),
        // a file that is there and holds no log
        LogError::Empty
        | LogError::WrongContent { .. }
        | LogError::NoVehicle { .. }
        | LogError::UnknownFormat { .. }
            if path.is_file() =>
        {
            StudyError::NoFlight { file: text::path(&path), why: error.to_string() }
        }
        _ => StudyError::File { file: text::path(&path), why: error.to_string() },
    }
}

/// Which of several vehicles it is.
fn whose(report: &ReadReport) -> Option<String> {
    let others: Vec<String> = report.others.iter().map(ToString::to_string).collect();
    report.vehicle.filter(|_| !others.is_empty()).map(|vehicle| {
        format!(
            "system {} is analysed; the log also contains system(s) {} (--system-id chooses another)",
            vehicle.system,
            others.join(", ")
        )
    })
}

/// Each flight under a name of its own; what is to be said of the log is said of the first.
fn of_log(flights: Vec<LogFlight>, log: &InputFile, report: &ReadReport) -> Vec<Flight> {
    let (of, logged_by) = (flights.len(), LoggedBy::of(report));
    let named = |(index, mut flight): (usize, LogFlight)| {
        // what an output was when it left the mixer is no setting of the flight before
        let off_mixer = outputs_off_mixer(&flight.recording);
        if let Some(first) = off_mixer.first() {
            flight.recording.end_at(first.left_s);
        }
        adopt_in_flight_parameters(&mut flight.recording);
        let mut input = log.clone();
        if index > 0 {
            input.notes.clear();
        }
        if let Some((from_s, to_s)) = flight.part_s {
            input.path =
                format!("{}, flight {} of {of} ({:.0} to {to_s:.0} s)", log.path, index + 1, from_s.max(0.0));
        }
        input.notes = input.notes.iter().map(|note| note.of_file(&input.path)).collect();
        let about = || About::File(input.path.clone());
        let told: Vec<Note> = off_mixer.iter().map(|off| Note::warning(about(), off.to_string())).collect();
        input.notes.extend(told);
        let from = flight.part_s.and_then(|(from_s, _)| Duration::try_from_secs_f64(from_s).ok());
        let from_us = from.and_then(|from| u64::try_from(from.as_micros()).ok()).unwrap_or(0);
        let start_utc_us = report.start_utc_us().map(|start_us| start_us.saturating_add(from_us));
        Flight { logged_by, start_utc_us, recording: flight.recording, input, off_mixer, actuator: None }
    };
    flights.into_iter().enumerate().map(named).collect()
}

/// The flights of every log, conditioned side by side for a vehicle of this file.
pub(super) fn prepare(
    logs: Vec<Vec<Flight>>,
    vehicle: (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<Prepared, StudyError> {
    let one = |log| ready(log, |flight: &Flight| flight.conditioned(vehicle, settings));
    let done: Vec<_> = logs.into_par_iter().map(one).collect();
    let mut prepared = Prepared::default();
    for log in done {
        for (flight, signals) in log? {
            prepared.recordings.push(flight.recording);
            prepared.inputs.push(flight.input);
            prepared.signals.push(signals);
        }
    }
    Ok(prepared)
}

/// The same. Where the motion excludes the torque per thrust, the vehicle with another one, a note on it, and the flights prepared for that.
/// What contradicts them is also in their quality.
pub(super) fn prepare_by_motion(
    logs: Vec<Vec<Flight>>,
    (vehicle, file): (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<(Prepared, Option<(Vehicle, Note)>), StudyError> {
    let prepared = prepare(logs.clone(), (vehicle, file), settings)?;
    let Some((corrected, note)) = torque_by_motion(&prepared.signals, vehicle) else {
        return Ok((prepared, None));
    };
    let mut prepared = prepare(logs, (&corrected, file), settings)?;
    if note.about == About::Contradiction {
        prepared.signals.iter_mut().for_each(|signals| signals.quality.notes.push(note.clone()));
    }
    Ok((prepared, Some((corrected, note))))
}

/// The flights of one log that can be made ready. Of several flights one that cannot is left out, and noted with the first
/// that can.
pub(super) fn ready<T>(
    log: Vec<Flight>,
    make: impl Fn(&Flight) -> Result<T, StudyError>,
) -> Result<Vec<(Flight, T)>, StudyError> {
    let (mut ready, mut refusal, mut notes) = (Vec::new(), None, Vec::new());
    for flight in log {
        match make(&flight) {
            Ok(made) => ready.push((flight, made)),
            Err(why) => {
                notes.extend(flight.input.notes);
                let text = format!("left out: {}", why.of_log().1);
                notes.push(Note::remark(About::File(flight.input.path), text));
                refusal.get_or_insert(why);
            }
        }
    }
    let Some(why) = refusal else { return Ok(ready) };
    let Some((first, _)) = ready.first_mut() else { return Err(why) };
    first.input.notes.splice(0..0, notes);
    Ok(ready)
}

/// Seconds of flight before an output left the mixer, from which on effects are searched in them. Set by judgement:
/// no flight of less shows them all.
const LEAST_BEFORE_S: f64 = 40.0;

/// Where an output left the mixer, what is to be explained is in the outputs themselves: a flight that was short until then gets no
/// name.
pub(super) fn refuse_off_mixer<'a>(logs: impl Iterator<Item = &'a Vec<Flight>>) -> Result<(), StudyError> {
    for flight in logs.flatten().filter(|flight| !flight.off_mixer.is_empty()) {
        let seconds = commanded_in_air_s(&flight.recording);
        if seconds < LEAST_BEFORE_S {
            let all: Vec<String> = flight.off_mixer.iter().map(ToString::to_string).collect();
            let why = format!(
                "{}: the log shows the cause, so mavid does not search for effects; before that it was in the air for {seconds:.0} s, \
                 expected {LEAST_BEFORE_S:.0} s at least",
                all.join("; ")
            );
            return Err(StudyError::File { file: flight.input.path.clone(), why });
        }
    }
    Ok(())
}

/// Time off the ground with commands, s, by what the autopilot says and by the height.
fn commanded_in_air_s(recording: &Recording) -> f64 {
    let said = ReportedState::of(recording);
    let commands = best(recording, Quantity::ActuatorCommand, |stream| !stream.is_empty());
    let times_s = commands.map_or(&[][..], |(_, stream)| stream.time_s.as_slice());
    let flown_s = spans(times_s, |index| said.may_be_off_ground(times_s[index]));
    off_ground(recording, flown_s).iter().map(|(from_s, to_s)| to_s - from_s).sum()
}

/// What is hardly meant in a vehicle's file.
pub(super) fn file_notes(file: &Path, warnings: &[Note]) -> Vec<Note> {
    warnings.iter().map(|warning| warning.of_file(&text::path(&file))).collect()
}

/// Names of logs in one line.
pub(super) fn names(logs: &[PathBuf]) -> String {
    logs.iter().map(|log| text::path(&log)).collect::<Vec<_>>().join(", ")
}
