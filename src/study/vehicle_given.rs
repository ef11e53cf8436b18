//! How a study is told of the vehicle: by a file, or by its mass and size.

use crate::autopilot::{Autopilot, is_simulated};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::config::{ConfigError, LoadedVehicle, ModelTables, read_vehicle, vehicle_to_toml};
use crate::draft::{Draft, DraftError, Given, draft};
use crate::log::{Hold, open_flights};
use crate::note::{About, Note};
use crate::recording::Recording;
use crate::signals::adopt_in_flight_parameters;
use crate::stand::{StandError, measured_propulsion, read_table};
use crate::text;
use crate::vehicle::{Guessed, Vehicle};

use super::StudyError;
use super::flight::Flight;
use super::flights::{ReadSettings, file_notes, refuse_other_kinds, unread};

/// How a study is told of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub enum VehicleGiven {
    /// a vehicle file or a model
    File(PathBuf),
    /// what a person knows; the rest is drafted from the first log, see [`crate::draft`]
    Weighed(Given),
}

impl Default for VehicleGiven {
    fn default() -> Self {
        Self::File(PathBuf::new())
    }
}

impl From<PathBuf> for VehicleGiven {
    fn from(file: PathBuf) -> Self {
        Self::File(file)
    }
}

/// What is kept of a log from which a vehicle is drafted: hover shows in minutes.
const DRAFTED_FROM: Hold = Hold { seconds: 600.0, numbers: 4_000_000, short_s: 0.0 };

/// The vehicle of a study.
#[derive(Debug)]
pub(super) struct Known {
    pub(super) loaded: LoadedVehicle,
    /// what messages call it
    pub(super) origin: PathBuf,
    /// where it was drafted
    pub(super) draft: Option<Draft>,
    /// share of the gyroscopic torque that its file states and that is not a body's, where the flights are not all a simulator's
    pub(super) not_a_bodys: Option<f64>,
}

impl Known {
    fn of(loaded: LoadedVehicle, origin: PathBuf, draft: Option<Draft>) -> Self {
        Self { loaded, origin, draft, not_a_bodys: None }
    }

    /// The whole gyroscopic torque acts in these flights unless all are a simulator's.
    fn turning_as_flown(mut self, logs: &[Vec<Flight>]) -> Self {
        let of_simulator =
            |flight: &Flight| is_simulated(|name| flight.recording.parameters.get(name).copied());
        let stated = std::mem::replace(&mut self.loaded.vehicle.body.gyroscopic, WHOLE);
        if logs.iter().flatten().all(of_simulator) {
            self.loaded.vehicle.body.gyroscopic = stated;
        } else if stated != WHOLE {
            self.not_a_bodys = Some(stated);
        }
        self
    }

    /// What is to be known of it.
    pub(super) fn notes(&self) -> Vec<Note> {
        let about = || About::File(text::path(&self.origin));
        match &self.draft {
            Some(draft) => draft_notes(draft),
            None => {
                let mut notes = file_notes(&self.origin, &self.loaded.warnings);
                notes.extend(self.not_a_bodys.map(|stated| Note::warning(about(), not_of_a_body(stated))));
                notes.extend(guesses(&self.loaded.vehicle).map(|text| Note::remark(about(), text)));
                notes
            }
        }
    }
}

/// Share of the gyroscopic torque that acts on every body.
const WHOLE: f64 = 1.0;

fn not_of_a_body(stated: f64) -> String {
    format!(
        "body.gyroscopic is {stated}, of a simulator that leaves the gyroscopic torque out, and the parameters in the logs do not say \
         that a simulator flew: the whole torque is taken, as it acts on every real vehicle"
    )
}

/// What is to be known of a drafted vehicle: what is hardly meant, what contradicts the log, where its values come from, and
/// which of them are guesses.
#[must_use]
pub fn draft_notes(draft: &Draft) -> Vec<Note> {
    let about = || About::File(DRAFTED.to_owned());
    let mut notes = file_notes(Path::new(DRAFTED), &implausible(draft));
    notes.extend(doubted(draft, &about()));
    notes.push(Note::remark(about(), draft.origins.join("; ")));
    notes.extend(guesses(&draft.vehicle).map(|text| Note::remark(about(), text)));
    notes
}

/// What is given and contradicts the log or the rest of what is given.
fn doubted(draft: &Draft, about: &About) -> impl Iterator<Item = Note> {
    draft.doubts.iter().map(|doubt| Note::warning(about.clone(), doubt.as_str()))
}

/// What is possible of a drafted vehicle but hardly meant.
#[must_use]
pub fn implausible(draft: &Draft) -> Vec<Note> {
    let doubts = draft.vehicle.implausible().into_iter();
    doubts.map(|doubt| Note::warning(About::Vehicle, doubt)).collect()
}

/// The guesses that a vehicle rests on, in a sentence.
fn guesses(vehicle: &Vehicle) -> Option<String> {
    let one = |guess: &crate::vehicle::Guess| {
        let why = if guess.why.is_empty() { String::new() } else { format!(" ({})", guess.why) };
        format!("{} +- {:.0} %{why}", guess.of.words(), 100.0 * guess.relative)
    };
    let all: Vec<String> = vehicle.guesses.iter().map(one).collect();
    (!all.is_empty()).then(|| format!("rests on guesses: {}", all.join("; ")))
}

impl VehicleGiven {
    /// The vehicle of a file, or drafted of mass and frame alone where there is neither a log nor a link; and what messages call
    /// it. The guesses that it rests on are among its warnings.
    ///
    /// # Errors
    /// The file cannot be read, or what is given is no vehicle's.
    pub fn alone(&self) -> Result<(LoadedVehicle, PathBuf), StudyError> {
        let (mut loaded, origin) = match self {
            Self::File(file) => (read_vehicle(file)?, file.clone()),
            Self::Weighed(given) => {
                let draft =
                    draft(&Recording::default(), given, "vehicle").map_err(|error| not_given(&error))?;
                (of_draft(&draft), PathBuf::from(DRAFTED))
            }
        };
        let guesses = guesses(&loaded.vehicle).map(|text| Note::warning(About::Vehicle, text));
        loaded.warnings.extend(guesses);
        Ok((loaded, origin))
    }

    /// The vehicle of a file; `None` where it is to be drafted from a log.
    pub(super) fn of_file(&self) -> Result<Option<Known>, StudyError> {
        match self {
            Self::File(file) => Ok(Some(Known::of(read_vehicle(file)?, file.clone(), None))),
            Self::Weighed(_) => Ok(None),
        }
    }

    /// A drafted vehicle has the actuator of the first log: commands of each log are read in its own unit. What a file states holds
    /// for all of them.
    pub(super) fn own_units(&self, logs: &mut [Vec<Flight>]) {
        if matches!(self, Self::Weighed(_)) {
            logs.iter_mut().flatten().for_each(Flight::read_in_own_unit);
        }
    }

    /// The vehicle, drafted from the first flight of the logs where it is not in a file. A file's share of the gyroscopic torque is that
    /// of a simulator, and holds where one flew.
    pub(super) fn of_flights(&self, known: Option<Known>, logs: &[Vec<Flight>]) -> Result<Known, StudyError> {
        let first = logs.iter().flatten().next();
        match (self, known, first) {
            (_, Some(known), _) => Ok(known.turning_as_flown(logs)),
            (Self::Weighed(given), None, Some(flight)) => {
                let draft = drafted(&flight.recording, &flight.input.path, given)?;
                Ok(Known::of(of_draft(&draft), PathBuf::from(DRAFTED), Some(draft)))
            }
            _ => Err(StudyError::Setting {
                name: "mass",
                why: "expected a log with a flight, got none".into(),
            }),
        }
    }
}

/// What messages call a vehicle that is of no file.
pub(super) const DRAFTED: &str = "the drafted vehicle";

fn of_draft(draft: &Draft) -> LoadedVehicle {
    LoadedVehicle {
        warnings: implausible(draft).into_iter().chain(doubted(draft, &About::Vehicle)).collect(),
        vehicle: draft.vehicle.clone(),
        model: ModelTables::default(),
    }
}

fn drafted(recording: &Recording, log: &str, given: &Given) -> Result<Draft, StudyError> {
    let name = Path::new(log).file_stem().map_or_else(|| "vehicle".to_owned(), text::path);
    draft(recording, given, &name).map_err(|error| match error {
        DraftError::Given { .. } => not_given(&error),
        _ => StudyError::File { file: log.to_owned(), why: error.to_string() },
    })
}

/// What was given on the command line and is no vehicle's.
fn not_given(error: &DraftError) -> StudyError {
    let name = if let DraftError::Given { what, .. } = error { what } else { "mass" };
    StudyError::Setting { name, why: error.to_string() }
}

/// Whether these can be the numbers of a multirotor: that is known before a log is read or a vehicle is waited for.
///
/// # Errors
/// One of them cannot.
pub fn check_given(given: &Given) -> Result<(), StudyError> {
    given.checked().map_err(|error| not_given(&error))
}

/// A first description of the vehicle of a log.
///
/// # Errors
/// The log cannot be read, or does not say enough.
pub fn draft_from_log(log: &Path, read: &ReadSettings, given: &Given) -> Result<Draft, StudyError> {
    let mut opened =
        open_flights(log, &read.open_options()?, &DRAFTED_FROM).map_err(|error| unread(log, error))?;
    refuse_other_kinds(log, &opened)?;
    let Some(flight) = opened.flights.flights.first_mut() else {
        return Err(StudyError::File { file: text::path(&log), why: "expected a flight, got none".into() });
    };
    adopt_in_flight_parameters(&mut flight.recording);
    drafted(&flight.recording, &text::path(&log), given)
}

/// A first description of a vehicle by its parameters alone, as they came over the link at `address`.
///
/// # Errors
/// They do not say enough.
pub fn draft_from_parameters(
    (autopilot, parameters): (Autopilot, BTreeMap<String, f64>),
    given: &Given,
    address: &str,
) -> Result<Draft, StudyError> {
    let recording = Recording { autopilot, parameters, ..Recording::default() };
    draft(&recording, given, "vehicle").map_err(|error| match error {
        DraftError::Given { .. } => not_given(&error),
        _ => StudyError::File { file: address.to_owned(), why: error.to_string() },
    })
}

/// A draft with what a thrust stand measured of one of its rotors in place of guesses.
///
/// # Errors
/// The table cannot be read, does not say enough, or says what no rotor does.
pub fn with_thrust_stand(mut draft: Draft, table: &Path) -> Result<Draft, StudyError> {
    let name = text::path(&table);
    let unusable = |error: StandError| match error {
        StandError::Read { .. } | StandError::TooLarge { .. } => {
            StudyError::Setting { name: "thrust-stand", why: error.to_string() }
        }
        _ => StudyError::File { file: name.clone(), why: error.to_string() },
    };
    let vehicle = &mut draft.vehicle;
    let read = read_table(table).map_err(unusable)?;
    let stand = measured_propulsion(&read, &vehicle.propulsion).map_err(unusable)?;
    if read.is_turned {
        draft.doubts.push(format!(
            "{name}: its thrust is negative: taken as positive, as of a stand that pushes the other way"
        ));
    }
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / vehicle.rotors.len() as f64;
    let hovers = vehicle.propulsion.command_from_thrust(weight_n);
    let by_flight = vehicle.guesses.iter().any(|guess| {
        guess.of == Guessed::ThrustMax && guess.relative < FLOWN && stand.measured.contains(&guess.of)
    });
    let lifted = stand.propulsion.thrust_from_command_n(hovers) / weight_n;
    if by_flight && !(1.0 / APART..=APART).contains(&lifted) {
        draft.doubts.push(format!(
            "{name}: at the command at which the log's vehicle hovers, the stand's thrust is {lifted:.2} times the weight: \
             another voltage, another rotor, or a wrong mass?"
        ));
    }
    vehicle.propulsion = stand.propulsion;
    vehicle.guesses.retain(|guess| !stand.measured.contains(&guess.of));
    draft.origins.extend(stand.sentences.into_iter().map(|sentence| format!("{name}: {sentence}")));
    Ok(draft)
}

/// A largest thrust that is known better than this is from a flight. A guess by class has a standard error of a fifth
/// and more.
const FLOWN: f64 = 0.1;
/// Thrusts of a stand and of a flight that are further apart contradict each other. Stands and flights differ by
/// wakes and batteries; only a warning depends on it.
const APART: f64 = 1.25;

/// A draft as a vehicle file, with where its values come from.
///
/// # Errors
/// [`ConfigError`] where a value has no form in TOML.
pub fn draft_text(draft: &Draft) -> Result<String, ConfigError> {
    let mut out = String::from(
        "# A first description of the vehicle. Every [[guess]] below was not measured: correct the value and delete the guess.\n",
    );
    for doubt in &draft.doubts {
        out.push_str(&text::line_comment("# - doubtful:", doubt));
    }
    for origin in &draft.origins {
        out.push_str(&text::line_comment("# -", origin));
    }
    out.push('\n');
    Ok(out + &vehicle_to_toml(&draft.vehicle)?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::simulate::random_vehicle;
    use crate::study::InputFile;
    use crate::study::flight::LoggedBy;

    fn known(share: f64, parameters: &[(&str, f64)]) -> Known {
        let mut vehicle = random_vehicle(1).nominal;
        vehicle.body.gyroscopic = share;
        let loaded = LoadedVehicle { vehicle, model: ModelTables::default(), warnings: Vec::new() };
        let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let flight = Flight {
            logged_by: LoggedBy::Vehicle,
            start_utc_us: None,
            recording: Recording { parameters, ..Recording::default() },
            input: InputFile {
                path: "log".to_owned(),
                sha256: String::new(),
                other_logs: Vec::new(),
                notes: Vec::new(),
            },
            off_mixer: Vec::new(),
            actuator: None,
        };
        Known::of(loaded, PathBuf::from("model.toml"), None).turning_as_flown(&[vec![flight]])
    }

    #[test]
    fn a_share_of_the_gyroscopic_torque_is_a_simulators() {
        let told = |known: &Known| known.notes().iter().any(|note| note.text.contains("body.gyroscopic"));
        let simulated = known(0.0, &[("SYS_HITL", 2.0)]);
        assert!(simulated.loaded.vehicle.body.gyroscopic == 0.0 && !told(&simulated));
        for parameters in [&[][..], &[("SYS_HITL", 0.0)][..]] {
            let real = known(0.0, parameters);
            assert!(real.loaded.vehicle.body.gyroscopic == 1.0 && told(&real), "{:?}", real.notes());
        }
        assert!(!told(&known(1.0, &[])));
    }
}
