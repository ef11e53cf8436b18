//! Flights of logs, whatever their format: read, conditioned, and told apart.

use std::path::{Path, PathBuf};

use crate::config::{default_csv_mapping, load_csv_mapping};
use crate::diagnose::holdout::HeldOut;
use crate::log::{Flights, Hold, LoadOptions, LoadedFlights, LogFlight, csv, load_flights};
use crate::note::{About, Note};
use crate::recording::{Recording, shared_share};
use crate::signals::{ConditionSettings, Signals, condition};
use crate::text;
use crate::vehicle::Vehicle;
use crate::wire::SystemId;
use rayon::prelude::*;

use super::{InputFile, StudyError};

/// What is identified and validated from of one log: it takes 20 MB a minute at 125 Hz.
pub(super) const IDENTIFIED: Hold = Hold { seconds: 1800.0, numbers: 9_000_000 };
/// What is explained of one log: it takes 75 MB a minute at 125 Hz on two cores, and 130 MB on eight.
pub(super) const EXPLAINED: Hold = Hold { seconds: 480.0, numbers: 3_000_000 };
/// Share of a hold-out's samples that may be in an explained flight: none are, but for chance.
const MOST_SHARED: f64 = 0.02;

/// How logs are read.
#[derive(Debug, Clone, Default)]
pub struct ReadSettings {
    /// what the columns of a CSV mean; `None`: the names in `configs/csv/default.toml`
    pub csv_map: Option<PathBuf>,
    /// the vehicle; `None`: the only one of the log that flew
    pub system: Option<SystemId>,
}

impl ReadSettings {
    /// A mapping of columns needs a CSV among the logs.
    ///
    /// # Errors
    /// [`StudyError::Setting`] otherwise.
    pub(super) fn check<'a>(&self, mut logs: impl Iterator<Item = &'a PathBuf>) -> Result<(), StudyError> {
        if self.csv_map.is_some() && !logs.any(|log| is_csv(log)) {
            let why = "expected a .csv among the logs, got none".to_owned();
            return Err(StudyError::Setting { name: "csv-map", why });
        }
        Ok(())
    }
}

/// A flight and the log that it came from.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) recording: Recording,
    /// name, hash, losses
    pub(super) input: InputFile,
}

/// Flights that are ready for estimation; all have one entry a flight.
#[derive(Debug, Default)]
pub(super) struct Prepared {
    pub(super) recordings: Vec<Recording>,
    pub(super) signals: Vec<Signals>,
    pub(super) inputs: Vec<InputFile>,
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
        each.map(|((recording, signals), input)| HeldOut {
            name: &input.path,
            signals,
            recording: Some(recording),
        })
        .collect()
    }
}

/// Read by a mapping of its columns.
pub(super) fn is_csv(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

/// The flights of every log, read side by side: each has at least one, and at most as much as `most`.
pub(super) fn load_all(
    logs: &[PathBuf],
    read: &ReadSettings,
    most: &Hold,
) -> Result<Vec<Vec<Flight>>, StudyError> {
    let done: Vec<_> = logs.par_iter().map(|path| load(path, read, most)).collect();
    done.into_iter().collect()
}

fn load(path: &Path, read: &ReadSettings, most: &Hold) -> Result<Vec<Flight>, StudyError> {
    let name = text::path(&path);
    let named =
        |error: &dyn std::fmt::Display| StudyError::File { file: name.clone(), why: error.to_string() };
    let (flights, losses, remarks) = if is_csv(path) {
        let mapping =
            read.csv_map.as_ref().map_or_else(default_csv_mapping, |file| load_csv_mapping(file))?;
        let (recording, report) = csv::read_csv(path, &mapping)?;
        (Flights::of(recording, most), report.losses(), Vec::new())
    } else {
        let options = LoadOptions { system: read.system };
        let loaded = load_flights(path, &options, most).map_err(|error| named(&error))?;
        let mut remarks: Vec<String> = whose(&loaded).into_iter().collect();
        remarks.extend(loaded.report.oddities());
        (loaded.flights, loaded.report.losses(), remarks)
    };
    let about = || About::File(name.clone());
    let losses = losses.into_iter().chain(left_out(&flights));
    let mut input = InputFile::of(path)?;
    input.notes.extend(losses.map(|text| Note::loss(about(), text)));
    input.notes.extend(remarks.into_iter().map(|text| Note::remark(about(), text)));
    Ok(of_log(flights.flights, &input))
}

/// Which of several vehicles it is.
fn whose(loaded: &LoadedFlights) -> Option<String> {
    let others: Vec<String> = loaded.others.iter().map(ToString::to_string).collect();
    (!others.is_empty()).then(|| {
        format!(
            "system {} is analysed; system(s) {} speak in the log as well (--system-id chooses another)",
            loaded.vehicle.system,
            others.join(", ")
        )
    })
}

/// What of a log is more than is held.
fn left_out(flights: &Flights) -> Option<String> {
    (flights.left_out_s > 0.0).then(|| {
        format!(
            "{:.0} s of flight at the end are left out: the log holds more than is analysed at once; cut it to analyse the rest",
            flights.left_out_s
        )
    })
}

/// Each flight under a name of its own; what is to be said of the log is said of the first.
fn of_log(flights: Vec<LogFlight>, log: &InputFile) -> Vec<Flight> {
    let of = flights.len();
    let named = |(index, flight): (usize, LogFlight)| {
        let mut input = log.clone();
        if index > 0 {
            input.notes.clear();
        }
        if let Some((from_s, to_s)) = flight.part_s {
            input.path = format!("{}, flight {} of {of} ({from_s:.0} to {to_s:.0} s)", log.path, index + 1);
        }
        Flight { recording: flight.recording, input }
    };
    flights.into_iter().enumerate().map(named).collect()
}

impl Flight {
    /// Conditioned for a vehicle of this file.
    pub(super) fn conditioned(
        &self,
        (vehicle, file): (&Vehicle, &Path),
        settings: &ConditionSettings,
    ) -> Result<Signals, StudyError> {
        condition(&self.recording, vehicle, settings).map_err(|source| StudyError::Flight {
            flight: self.input.path.clone(),
            vehicle: text::path(&file),
            source,
            losses: self.input.losses().into_iter().map(str::to_owned).collect(),
        })
    }
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
                notes.push(Note::remark(About::File(flight.input.path), format!("left out: {why}")));
                refusal.get_or_insert(why);
            }
        }
    }
    let Some(why) = refusal else { return Ok(ready) };
    let Some((first, _)) = ready.first_mut() else { return Err(why) };
    first.input.notes.splice(0..0, notes);
    Ok(ready)
}

/// The share (0..1) of a recording that the other holds as well, where it is more than chance.
pub(super) fn shared(of: &Recording, other: &Recording) -> Option<f64> {
    Some(shared_share(of, other)).filter(|share| *share > MOST_SHARED)
}

/// The same file twice is refused; `logs` are the flights of each.
pub(super) fn refuse_twins<'a>(logs: impl Iterator<Item = &'a Vec<Flight>>) -> Result<(), StudyError> {
    let inputs: Vec<&InputFile> = logs.filter_map(|log| log.first()).map(|flight| &flight.input).collect();
    for (index, input) in inputs.iter().enumerate() {
        if let Some(twin) = inputs[..index].iter().find(|other| other.sha256 == input.sha256) {
            return Err(StudyError::Twins { one: twin.path.clone(), other: input.path.clone() });
        }
    }
    Ok(())
}

/// What is hardly meant in a vehicle's file.
pub(super) fn file_notes(file: &Path, warnings: &[String]) -> Vec<Note> {
    let about = || About::File(text::path(&file));
    warnings.iter().map(|warning| Note::warning(about(), warning.as_str())).collect()
}

/// Names of logs in one line.
pub(super) fn names(logs: &[PathBuf]) -> String {
    logs.iter().map(|log| text::path(&log)).collect::<Vec<_>>().join(", ")
}
