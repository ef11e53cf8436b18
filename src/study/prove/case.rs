//! One case: explained, shown on its hold-out, and put down as a verdict.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::folders::{VEHICLE, logs};
use crate::config::read_vehicle;
use crate::diagnose::holdout::{Explained, HoldoutFit, HoldoutSettings, on_holdout};
use crate::diagnose::{Empirical, ExplainSettings, Explanation, Named, explain};
use crate::note::Note;
use crate::signals::{ConditionSettings, ThrustPreference};
use crate::study::flights::{EXPLAINED, Prepared, load_all, prepare};
use crate::study::same_flight::shared;
use crate::study::{ExplainRequest, ReadSettings, StudyError};
use crate::text;
use crate::vehicle::Vehicle;
use serde::Serialize;

/// What was found, as it is sealed.
#[derive(Debug, Clone, Serialize)]
pub struct CaseVerdict {
    /// version of the document
    pub schema: u32,
    /// name of its folder
    pub case: String,
    /// `error` where the case could not be explained
    pub verdict: String,
    /// what was named
    pub effects: Vec<CaseEffect>,
    /// where nothing serves: what comes closest
    pub closest: Vec<String>,
    /// what an empirical term depends on, where one helps
    pub empirical: Option<String>,
    /// on its hold-out; `None` without one
    pub holdout: Option<Gain>,
    /// why it could not be explained
    pub error: Option<String>,
    /// of the logs that were read, in order
    pub sha256: Vec<String>,
    /// wall clock
    #[serde(skip)]
    pub seconds: f64,
}

/// A named effect.
#[derive(Debug, Clone, Serialize)]
pub struct CaseEffect {
    /// identifier of the effect
    pub id: String,
    /// its values
    pub parameters: Vec<CaseParameter>,
    /// identifiers of the effects with which it can be confused
    pub confusable_with: Vec<String>,
}

/// One of its values.
#[derive(Debug, Clone, Serialize)]
pub struct CaseParameter {
    /// name of the parameter
    pub name: String,
    /// in `unit`
    pub value: f64,
    /// standard error
    pub std: f64,
    /// SI
    pub unit: String,
}

/// The fit on the hold-out.
#[derive(Debug, Clone, Serialize)]
pub struct Gain {
    /// mean of position, velocity, attitude and rates over windows of 0.5 s
    pub improvement_percent: Option<f64>,
    /// interval that holds 95 of 100 resamplings
    pub improvement_range: Option<(f64, f64)>,
    /// m, m/s, rad, rad/s: before, after, floor
    pub half_second: [Option<[Option<f64>; 3]>; 4],
    /// why the hold-out cannot be of this vehicle
    pub other_vehicle: Option<String>,
    /// what was not simply kept
    pub notes: Vec<Note>,
}

/// Explains a case; whatever fails is part of the verdict.
pub fn verdict(folder: &Path) -> CaseVerdict {
    let case = folder.file_name().map_or_else(String::new, |name| text::path(&name));
    let started = Instant::now();
    let mut sha256 = Vec::new();
    let found = explained(folder, &mut sha256);
    let seconds = started.elapsed().as_secs_f64();
    let empty = CaseVerdict {
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
        Ok((explanation, empirical, shown)) => CaseVerdict {
            verdict: explanation.verdict.name().to_owned(),
            effects: explanation.named.iter().map(effect).collect(),
            closest: explanation.closest.iter().map(|named| named.id.to_owned()).collect(),
            empirical: empirical.map(|term| term.along.name().to_owned()),
            holdout: shown.as_ref().map(gain),
            ..empty
        },
        Err(error) => CaseVerdict { error: Some(error.to_string()), ..empty },
    }
}

type Found = (Explanation, Option<Empirical>, Option<HoldoutFit>);

fn explained(folder: &Path, sha256: &mut Vec<String>) -> Result<Found, StudyError> {
    let vehicle = read_vehicle(&folder.join(VEHICLE))?.vehicle;
    let (used, held) = logs(folder)?;
    let used = flights_of(&used, (&vehicle, folder), sha256)?;
    let inputs = sha256.len();
    let settings = ExplainSettings::default();
    let refuse = |error: &dyn std::fmt::Display| StudyError::Case(error.to_string());
    let explanation = explain(&used.signals, &vehicle, &settings).map_err(|error| refuse(&error))?;
    let empirical =
        Empirical::fit(&explanation, &used.signals, &vehicle, &settings).map_err(|error| refuse(&error))?;
    let held = flights_of(&held, (&vehicle, folder), sha256)?;
    if let Some(twin) = sha256[inputs..].iter().find(|hash| sha256[..inputs].contains(hash)) {
        return Err(refuse(&format!("the hold-out is the flight that it is to be predicted from ({twin})")));
    }
    for hold_out in &held.recordings {
        if let Some(share) = used.recordings.iter().find_map(|recording| shared(hold_out, recording)) {
            let percent = 100.0 * share;
            return Err(refuse(&format!("{percent:.0} % of the hold-out are in a flight that is explained")));
        }
    }
    if held.is_empty() {
        return Ok((explanation, empirical, None));
    }
    let model = Explained { explanation: &explanation, empirical: empirical.as_ref(), rate_law: None };
    let shown = on_holdout(model, &held.held_out(), &vehicle, &HoldoutSettings::default())
        .map_err(|error| refuse(&error))?;
    Ok((explanation, empirical, Some(shown)))
}

/// The flights of these logs, ready; their hashes are noted, one a log.
fn flights_of(
    files: &[PathBuf],
    (vehicle, folder): (&Vehicle, &Path),
    sha256: &mut Vec<String>,
) -> Result<Prepared, StudyError> {
    let settings = ConditionSettings {
        transient_s: Some(ExplainRequest::TRANSIENT_S),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let flights = load_all(files, &ReadSettings::default(), &EXPLAINED)?;
    sha256.extend(flights.iter().filter_map(|log| log.first()).map(|flight| flight.input.sha256.clone()));
    prepare(flights, (vehicle, &folder.join(VEHICLE)), &settings)
}

fn effect(named: &Named) -> CaseEffect {
    let parameters = named.parameters.iter().map(|parameter| CaseParameter {
        name: parameter.name.to_owned(),
        value: parameter.value,
        std: parameter.std,
        unit: parameter.unit.to_owned(),
    });
    CaseEffect {
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
