//! Inspects, conditions, balances and explains one log.

use super::request::{AloneRequest, Depth, OwnWords, Whose};
use super::result::{AloneFlight, AloneStudy, Explained};
use super::vibration::vibration_m_s2;
use crate::config::LoadedVehicle;
use crate::diagnose::{ExplainSettings, explain, of_one_flight};
use crate::inspect::inspect;
use crate::log::{self, OpenOptions};
use crate::note::{About, Note};
use crate::recording::{Event, Recording};
use crate::signals::{ConditionSettings, STEP_FOR_EFFECTS_S, Signals, ThrustPreference};
use crate::study::compare::{UNKNOWN, is_compared, power_w};
use crate::study::flight::Flight;
use crate::study::flights::{EXPLAINED, Prepared, load_all, prepare};
use crate::study::vehicle_given::Known;
use crate::study::{CompareRequest, InputFile, StudyError, VehicleGiven, unread};
use crate::trim::legs;
use crate::vehicle::Vehicle;
use crate::wire::SystemId;
use std::collections::BTreeMap;
use std::path::Path;

/// Studies one log by itself; `whose` says which vehicle it is of. A log whose flights cannot be studied is inspected all the same,
/// and the result says why.
///
/// # Errors
/// [`StudyError`] where the log cannot be read at all, or the vehicle's file cannot be used.
pub fn alone(request: &AloneRequest, whose: &Whose<'_>) -> Result<AloneStudy, StudyError> {
    let options = request.read.open_options()?;
    let path = request.log.as_path();
    let inspection = inspect(path, &options, None, &mut |_| ()).map_err(|error| unread(path, error))?;
    let system = options.system.or_else(|| inspection.vehicle.system.map(SystemId));
    let parameters = parameters(path, &OpenOptions { system, ..options });
    let own = OwnWords {
        system: inspection.vehicle.system,
        autopilot: inspection.vehicle.autopilot,
        parameters: &parameters,
    };
    let given = whose(&own);
    let mut study = AloneStudy {
        inspection,
        vehicle: None,
        is_known: given.is_some(),
        parameters,
        flights: Vec::new(),
        refused: None,
        notes: Vec::new(),
    };
    if request.depth > Depth::Inspect {
        match study.inspection.unflown.as_ref().map(|unflown| unflown.why.clone()) {
            Some(why) => study.refused = Some(why),
            None => fly(request, given, &mut study)?,
        }
    }
    Ok(study)
}

/// The vehicle's parameters as a log has them at last; none where it cannot be read to its end.
fn parameters(path: &Path, options: &OpenOptions) -> BTreeMap<String, f64> {
    let mut parameters = BTreeMap::new();
    let read = log::stream(path, options, &mut |_, event| match event {
        Event::Parameter { name, value } => {
            parameters.insert(name.to_owned(), value);
        }
        Event::ParameterDefault { name, value } => {
            parameters.entry(name.to_owned()).or_insert(value);
        }
        _ => (),
    });
    read.map(|_| parameters).unwrap_or_default()
}

/// Studies the flights of a log. A log that holds none that can be used says why; a vehicle's file that cannot be used is an error.
fn fly(
    request: &AloneRequest,
    given: Option<VehicleGiven>,
    study: &mut AloneStudy,
) -> Result<(), StudyError> {
    let of_file = given.as_ref().map(VehicleGiven::of_file).transpose()?.flatten();
    study.refused = flights(request, (given, of_file), study).err().map(|error| error.to_string());
    Ok(())
}

fn flights(
    request: &AloneRequest,
    (given, of_file): (Option<VehicleGiven>, Option<Known>),
    study: &mut AloneStudy,
) -> Result<(), StudyError> {
    let log = load_all(std::slice::from_ref(&request.log), &request.read, &EXPLAINED)?;
    let is_known = given.is_some();
    let known = given.unwrap_or(VehicleGiven::Weighed(UNKNOWN)).of_flights(of_file, &log)?;
    if is_known {
        study.notes = known.notes();
    }
    let Known { loaded: LoadedVehicle { vehicle, .. }, origin, .. } = known;
    study.vehicle = Some(vehicle.clone());
    let settings = ConditionSettings {
        transient_s: Some(CompareRequest::TRANSIENT_S),
        thrust: ThrustPreference::Commands,
        least_step_s: STEP_FOR_EFFECTS_S,
        ..ConditionSettings::default()
    };
    let off_mixer = log.iter().flatten().any(|flight: &Flight| !flight.off_mixer.is_empty());
    let Prepared { recordings, signals, inputs, .. } = prepare(log, (&vehicle, &origin), &settings)?;
    let why_not = match (request.depth, is_known) {
        (Depth::Explain, true) if off_mixer => {
            Some("a motor output does not follow the controllers: the log itself shows the cause")
        }
        (Depth::Explain, true) => None,
        (Depth::Explain, false) => Some("neither mass nor lengths of the vehicle are known"),
        _ => Some("not asked for"),
    };
    let each = recordings.iter().zip(signals).zip(inputs);
    let studied =
        each.map(|((recording, signals), input)| flight((recording, &signals), input, (&vehicle, why_not)));
    study.flights = studied.collect();
    Ok(())
}

fn flight(
    (recording, signals): (&Recording, &Signals),
    input: InputFile,
    (vehicle, why_not): (&Vehicle, Option<&str>),
) -> AloneFlight {
    let doubts = signals.quality.notes.iter().filter(|note| note.is_warning());
    let about = || About::File(input.path.clone());
    AloneFlight {
        airborne_s: signals.quality.airborne_s.clone(),
        legs: legs(signals, vehicle).map_err(|why| why.to_string()),
        power_w: power_w(recording, signals),
        vibration_m_s2: vibration_m_s2(recording, &signals.quality.airborne_s),
        explained: why_not.map_or_else(|| explained(signals, vehicle), |why| Err(why.to_owned())),
        doubts: doubts.map(|note| Note::warning(about(), note.text.as_str())).collect(),
        input,
    }
}

fn explained(signals: &Signals, vehicle: &Vehicle) -> Result<Explained, String> {
    if !signals.quality.torques {
        return Err("commands or body rates are logged too seldom to compare torques".to_owned());
    }
    let settings = ExplainSettings::default();
    let explanation =
        explain(std::slice::from_ref(signals), vehicle, &settings).map_err(|error| error.to_string())?;
    let mut parameters = of_one_flight(signals, &explanation, vehicle, &settings);
    parameters.retain(is_compared);
    Ok(Explained { explanation, parameters })
}
