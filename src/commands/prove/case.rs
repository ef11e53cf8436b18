//! One case: explained, shown on its hold-out, and put down as a verdict.

use std::path::{Path, PathBuf};
use std::time::Instant;

use mavid::config::read_vehicle;
use mavid::diagnose::holdout::{HeldOut, HoldoutFit, HoldoutSettings, on_holdout};
use mavid::diagnose::{Empirical, ExplainSettings, Explanation, Named, explain};
use mavid::recording::Recording;
use mavid::signals::{ConditionSettings, Signals, ThrustPreference, condition};
use mavid::text;
use mavid::vehicle::Vehicle;
use serde::Serialize;

use crate::cli::ReadArgs;
use crate::commands::CommandError;
use crate::commands::flights::{EXPLAINED, load, ready, shared};

/// The vehicle file of a case.
pub const VEHICLE: &str = "vehicle.toml";
/// s of flight left out at the beginning: hover teaches little, but it is flight.
const TRANSIENT_S: f64 = 1.0;

/// What was found, as it is sealed.
#[derive(Debug, Clone, Serialize)]
pub struct Verdict {
    pub schema: u32,
    pub case: String,
    /// `error` where the case could not be explained
    pub verdict: String,
    pub effects: Vec<Effect>,
    /// where nothing serves: what comes closest
    pub closest: Vec<String>,
    /// what an empirical term depends on, where one helps
    pub empirical: Option<String>,
    pub holdout: Option<Gain>,
    pub error: Option<String>,
    /// of the logs that were read, in order
    pub sha256: Vec<String>,
    #[serde(skip)]
    pub seconds: f64,
}

/// A named effect.
#[derive(Debug, Clone, Serialize)]
pub struct Effect {
    pub id: String,
    pub parameters: Vec<Parameter>,
    pub confusable_with: Vec<String>,
}

/// One of its values.
#[derive(Debug, Clone, Serialize)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    pub std: f64,
    pub unit: String,
}

/// The fit on the hold-out.
#[derive(Debug, Clone, Serialize)]
pub struct Gain {
    /// mean of position, velocity, attitude and rates over windows of 0.5 s
    pub improvement_percent: Option<f64>,
    pub improvement_range: Option<(f64, f64)>,
    /// m, m/s, rad, rad/s: before, after, floor
    pub half_second: [Option<[Option<f64>; 3]>; 4],
    pub other_vehicle: Option<String>,
    pub notes: Vec<String>,
}

/// Explains a case; whatever fails is part of the verdict.
pub fn verdict(folder: &Path) -> Verdict {
    let case = folder.file_name().map_or_else(String::new, |name| text::path(&name));
    let started = Instant::now();
    let mut sha256 = Vec::new();
    let found = explained(folder, &mut sha256);
    let seconds = started.elapsed().as_secs_f64();
    let empty = Verdict {
        schema: 1,
        case,
        verdict: "error".to_owned(),
        effects: Vec::new(),
        closest: Vec::new(),
        empirical: None,
        holdout: None,
        error: None,
        sha256,
        seconds,
    };
    match found {
        Ok((explanation, empirical, shown)) => Verdict {
            verdict: explanation.verdict.name().to_owned(),
            effects: explanation.named.iter().map(effect).collect(),
            closest: explanation.closest.iter().map(|named| named.id.to_owned()).collect(),
            empirical: empirical.map(|term| term.along.name().to_owned()),
            holdout: shown.as_ref().map(gain),
            ..empty
        },
        Err(error) => Verdict { error: Some(error.to_string()), ..empty },
    }
}

type Found = (Explanation, Option<Empirical>, Option<HoldoutFit>);

fn explained(folder: &Path, sha256: &mut Vec<String>) -> Result<Found, CommandError> {
    let vehicle = read_vehicle(&folder.join(VEHICLE))?.vehicle;
    let (used, held) = logs(folder)?;
    let flights = used.iter().map(|log| flights_of(log, &vehicle, sha256)).collect::<Result<Vec<_>, _>>()?;
    let inputs = sha256.len();
    let (recordings, signals): (Vec<Recording>, Vec<Signals>) = flights.into_iter().flatten().unzip();
    let settings = ExplainSettings::default();
    let refuse = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let explanation = explain(&signals, &vehicle, &settings).map_err(|error| refuse(&error))?;
    let empirical =
        Empirical::fit(&explanation, &signals, &vehicle, &settings).map_err(|error| refuse(&error))?;
    let held = held.iter().map(|log| flights_of(log, &vehicle, sha256)).collect::<Result<Vec<_>, _>>()?;
    let held: Vec<(Recording, Signals)> = held.into_iter().flatten().collect();
    if let Some(twin) = sha256[inputs..].iter().find(|hash| sha256[..inputs].contains(hash)) {
        return Err(refuse(&format!("the hold-out is the flight that it is to be predicted from ({twin})")));
    }
    for (hold_out, _) in &held {
        if let Some(share) = recordings.iter().find_map(|recording| shared(hold_out, recording)) {
            let percent = 100.0 * share;
            return Err(refuse(&format!("{percent:.0} % of the hold-out are in a flight that is explained")));
        }
    }
    if held.is_empty() {
        return Ok((explanation, empirical, None));
    }
    let flights: Vec<HeldOut> = held
        .iter()
        .map(|(recording, signals)| HeldOut { name: "holdout", signals, recording: Some(recording) })
        .collect();
    let shown =
        on_holdout((&explanation, empirical.as_ref()), &flights, &vehicle, &HoldoutSettings::default())
            .map_err(|error| refuse(&error))?;
    Ok((explanation, empirical, Some(shown)))
}

/// Those to explain from, and those named `holdout...`.
fn logs(folder: &Path) -> Result<(Vec<PathBuf>, Vec<PathBuf>), CommandError> {
    let refuse =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&folder)));
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|error| refuse(&error))? {
        let path = entry.map_err(|error| refuse(&error))?.path();
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if ["tlog", "csv", "ulg", "bin"].iter().any(|known| extension.eq_ignore_ascii_case(known)) {
            all.push(path);
        }
    }
    all.sort();
    let (held, mut used): (Vec<PathBuf>, Vec<PathBuf>) =
        all.into_iter().partition(|path| starts(path, "holdout"));
    if used.iter().any(|path| starts(path, "identify")) {
        used.retain(|path| starts(path, "identify"));
    }
    if used.is_empty() {
        return Err(refuse(&"expected identify.tlog or other logs, found none"));
    }
    Ok((used, held))
}

fn starts(path: &Path, with: &str) -> bool {
    path.file_stem().and_then(|stem| stem.to_str()).is_some_and(|stem| stem.starts_with(with))
}

fn flights_of(
    log: &Path,
    vehicle: &Vehicle,
    sha256: &mut Vec<String>,
) -> Result<Vec<(Recording, Signals)>, CommandError> {
    let settings = ConditionSettings {
        transient_s: Some(TRANSIENT_S),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let flights = ready(load(log, &ReadArgs::default(), &EXPLAINED)?, |flight| {
        condition(&flight.recording, vehicle, &settings)
            .map_err(|error| CommandError::Input(format!("{}: {error}", text::path(&log))))
    })?;
    sha256.extend(flights.first().map(|(flight, _)| flight.input.sha256.clone()));
    Ok(flights.into_iter().map(|(flight, signals)| (flight.recording, signals)).collect())
}

fn effect(named: &Named) -> Effect {
    let parameters = named.parameters.iter().map(|parameter| Parameter {
        name: parameter.name.to_owned(),
        value: parameter.value,
        std: parameter.std,
        unit: parameter.unit.to_owned(),
    });
    Effect {
        id: named.id.to_owned(),
        parameters: parameters.collect(),
        confusable_with: named.confusable_with.iter().map(|other| other.id.to_owned()).collect(),
    }
}

fn gain(shown: &HoldoutFit) -> Gain {
    let quantities = shown.half_second().map_or([None; 4], |of| of.quantities());
    Gain {
        improvement_percent: shown.improvement_percent.map(|improvement| improvement.value),
        improvement_range: shown.improvement_percent.and_then(|improvement| improvement.range),
        half_second: quantities
            .map(|quantity| quantity.map(|of| [Some(of.before.value), Some(of.after.value), of.floor])),
        other_vehicle: shown.other_vehicle.as_ref().map(|other| other.reason.clone()),
        notes: shown.notes.clone(),
    }
}
