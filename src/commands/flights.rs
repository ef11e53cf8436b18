//! Loads recordings, whatever their format.

use mavid::config::{default_csv_mapping, load_csv_mapping};
use mavid::log::{Flights, Hold, LoadOptions, LoadedFlights, LogFlight, csv, load_flights};
use mavid::recording::{Recording, shared_share};
use mavid::report::InputFile;
use mavid::signals::{ConditionSettings, Signals, condition};
use mavid::text;
use mavid::vehicle::Vehicle;
use mavid::wire::SystemId;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::path::Path;

use super::{CommandError, Outcome, output};
use crate::cli::ReadArgs;

/// What is identified and validated from of one log: it takes 20 MB a minute at 125 Hz.
pub const IDENTIFIED: Hold = Hold { seconds: 1800.0, numbers: 9_000_000 };
/// What is explained of one log: it takes 75 MB a minute at 125 Hz on two cores, and 130 MB on eight.
pub const EXPLAINED: Hold = Hold { seconds: 480.0, numbers: 3_000_000 };

/// A flight and the log that it came from.
#[derive(Debug)]
pub struct Flight {
    /// the recording
    pub recording: Recording,
    /// name, hash, losses
    pub input: InputFile,
}

impl Flight {
    /// Conditioned for a vehicle of this file. A refusal names the log, the vehicle's file, and what was lost of
    /// the log in reading.
    pub fn conditioned(
        &self,
        (vehicle, file): (&Vehicle, &Path),
        settings: &ConditionSettings,
    ) -> Result<Signals, CommandError> {
        condition(&self.recording, vehicle, settings).map_err(|error| {
            let InputFile { path, losses, .. } = &self.input;
            let lost = if losses.is_empty() {
                String::new()
            } else {
                format!("; not read of the log: {}", losses.join("; "))
            };
            CommandError::Input(format!("{path} with {}: {error}{lost}", text::path(&file)))
        })
    }
}

/// Read by a mapping of its columns.
pub fn is_csv(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

/// Reads the flights of one log, at least one and at most `most`.
pub fn load(path: &Path, read: &ReadArgs, most: &Hold) -> Result<Vec<Flight>, CommandError> {
    let named =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&path)));
    let (flights, mut losses, notes) = if is_csv(path) {
        let mapping =
            read.csv_map.as_ref().map_or_else(default_csv_mapping, |file| load_csv_mapping(file))?;
        let (recording, report) =
            csv::read_csv(path, &mapping).map_err(|error| CommandError::Input(error.to_string()))?;
        (Flights::of(recording, most), report.losses(), Vec::new())
    } else {
        let options = LoadOptions { system: read.system.map(SystemId) };
        let loaded = load_flights(path, &options, most).map_err(|error| named(&error))?;
        let mut notes: Vec<String> = whose(&loaded).into_iter().collect();
        notes.extend(loaded.report.oddities());
        (loaded.flights, loaded.report.losses(), notes)
    };
    losses.extend(left_out(&flights));
    let sha256 = sha256_of(path).map_err(|error| named(&error))?;
    let log = InputFile { path: text::path(&path), sha256, losses, notes };
    Ok(of_log(flights.flights, &log))
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
            (input.losses, input.notes) = (Vec::new(), Vec::new());
        }
        if let Some((from_s, to_s)) = flight.part_s {
            input.path = format!("{}, flight {} of {of} ({from_s:.0} to {to_s:.0} s)", log.path, index + 1);
        }
        Flight { recording: flight.recording, input }
    };
    flights.into_iter().enumerate().map(named).collect()
}

/// The flights of one log that can be made ready. Of several flights one that cannot is left out, and noted with the first
/// that can.
pub fn ready<T>(
    log: Vec<Flight>,
    make: impl Fn(&Flight) -> Result<T, CommandError>,
) -> Result<Vec<(Flight, T)>, CommandError> {
    let (mut ready, mut refusal) = (Vec::new(), None);
    let (mut losses, mut notes) = (Vec::new(), Vec::new());
    for flight in log {
        match make(&flight) {
            Ok(made) => ready.push((flight, made)),
            Err(why) => {
                losses.extend(flight.input.losses);
                notes.extend(flight.input.notes);
                notes.push(format!("left out: {why}"));
                refusal.get_or_insert(why);
            }
        }
    }
    let Some(why) = refusal else { return Ok(ready) };
    let Some((first, _)) = ready.first_mut() else { return Err(why) };
    first.input.losses.splice(0..0, losses);
    first.input.notes.splice(0..0, notes);
    Ok(ready)
}

/// Says what is to be known of the logs, and what of them was lost.
pub fn say<'a>(inputs: impl Iterator<Item = &'a InputFile>) -> Outcome {
    let mut outcome = Outcome::Done;
    for input in inputs {
        input.notes.iter().for_each(|note| output::message(&format!("{}: {note}", input.path)));
        if !input.losses.is_empty() {
            output::message(&format!("{}: {}", input.path, input.losses.join("; ")));
            outcome = Outcome::DoneWithLoss;
        }
    }
    outcome
}

/// A file that is no recording, for the provenance.
pub fn file(path: &Path) -> Result<InputFile, CommandError> {
    let sha256 =
        sha256_of(path).map_err(|error| CommandError::Input(format!("{}: {error}", text::path(&path))))?;
    Ok(InputFile { path: text::path(&path), sha256, losses: Vec::new(), notes: Vec::new() })
}

/// Share of a hold-out's samples that may be in an explained flight: none are, but for chance.
const MOST_SHARED: f64 = 0.02;

/// The share (0..1) of a recording that the other holds as well, where it is more than chance.
pub fn shared(of: &Recording, other: &Recording) -> Option<f64> {
    Some(shared_share(of, other)).filter(|share| *share > MOST_SHARED)
}

/// The same file twice is refused; `logs` are the flights of each.
pub fn refuse_twins(logs: &[&[Flight]]) -> Result<(), CommandError> {
    let inputs: Vec<&InputFile> =
        logs.iter().filter_map(|log| log.first()).map(|flight| &flight.input).collect();
    for (index, input) in inputs.iter().enumerate() {
        if let Some(twin) = inputs[..index].iter().find(|other| other.sha256 == input.sha256) {
            return Err(CommandError::Input(format!(
                "{} and {} are the same recording byte for byte; expected different flights",
                twin.path, input.path
            )));
        }
    }
    Ok(())
}

fn sha256_of(path: &Path) -> std::io::Result<String> {
    let mut hasher = Sha256::new();
    std::io::copy(&mut std::fs::File::open(path)?, &mut hasher)?;
    Ok(hasher.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
