//! The models that are compared.

use std::path::{Path, PathBuf};

use super::result::ValidatedModel;
use crate::config::{LoadedVehicle, effects_of, read_vehicle};
use crate::diagnose::holdout::RateLaw;
use crate::draft::Given;
use crate::note::{About, Note};
use crate::physics::Model;
use crate::study::flight::Flight;
use crate::study::flights::file_notes;
use crate::study::{InputFile, Progress, StudyError, VehicleGiven, with_stated_lag};
use crate::text;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use serde::Deserialize;

/// A model, ready to fly.
pub(super) struct Contender {
    pub(super) of: ValidatedModel,
    pub(super) vehicle: Vehicle,
    pub(super) model: Model,
    /// for predictions in open loop: the same, or with the law of the rates that its file has for them
    pub(super) predicting: Model,
}

/// All models by name, and what is doubtful about their files.
pub(super) fn contenders(
    files: &[PathBuf],
    progress: &dyn Progress,
) -> Result<(Vec<Contender>, Vec<Note>), StudyError> {
    let mut notes = Vec::new();
    let mut models = Vec::with_capacity(files.len());
    for file in files {
        let loaded = read_vehicle(file)?;
        let doubts = file_notes(file, &loaded.warnings);
        doubts.iter().for_each(|note| progress.note(note));
        notes.extend(doubts);
        if loaded.model.identified.as_ref().is_some_and(|table| table.contains_key(RATE_LAW)) {
            let by_law = Note::remark(About::File(text::path(&file)), BY_LAW);
            progress.note(&by_law);
            notes.push(by_law);
        }
        models.push(contender(file, loaded)?);
    }
    tell_apart(&mut models, files);
    Ok((models, notes))
}

/// Table of a law of the rates below `[identified]`.
const RATE_LAW: &str = "rate_law";
/// Said of a model with one.
const BY_LAW: &str = "attitude and rates in open loop are predicted with the empirical law of the rates that this file has \
                      ([identified.rate_law]); closed loops and output predictions are without it";

fn contender(file: &Path, loaded: LoadedVehicle) -> Result<Contender, StudyError> {
    let name = file.file_stem().map_or_else(|| loaded.vehicle.name.clone(), |stem| text::path(&stem));
    let input = InputFile::of(file)?;
    flying(loaded, ValidatedModel { name, input })
}

fn flying(loaded: LoadedVehicle, of: ValidatedModel) -> Result<Contender, StudyError> {
    let file = || of.input.path.clone();
    let effects = effects_of(&loaded.model.effects, &file(), &loaded.vehicle)?;
    let effects = with_stated_lag(effects, &loaded.vehicle);
    let refused = |why: String| StudyError::File { file: file(), why };
    let model = Model::new(&loaded.vehicle, effects).map_err(|error| refused(error.to_string()))?;
    let law = rate_law(loaded.model.identified.as_ref()).map_err(refused)?;
    let predicting = law.map_or(Ok(model.clone()), |law| law.acting_in(&model));
    let predicting = predicting.map_err(|error| refused(format!("identified.rate_law: {error}")))?;
    Ok(Contender { of, vehicle: loaded.vehicle, model, predicting })
}

/// The law of the body rates that a model file has for predictions in open loop.
fn rate_law(identified: Option<&toml::Table>) -> Result<Option<RateLaw>, String> {
    /// As `explain` writes it.
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Law {
        share: [f64; 3],
        decay_1_s: [f64; 3],
        offset_rad_s2: [f64; 3],
    }
    let Some(table) = identified.and_then(|table| table.get(RATE_LAW)) else { return Ok(None) };
    let unread = |error: toml::de::Error| format!("identified.rate_law: {}", error.message());
    let Law { share, decay_1_s, offset_rad_s2 } = table.clone().try_into().map_err(unread)?;
    let within = share.iter().all(|of| (0.0..=1.0).contains(of))
        && decay_1_s.iter().all(|of| (0.0..f64::INFINITY).contains(of))
        && offset_rad_s2.iter().all(|of| of.is_finite());
    if !within {
        return Err(format!(
            "identified.rate_law: expected shares from 0 to 1, decays from 0 on and finite offsets, got {share:?}, {decay_1_s:?}, \
             {offset_rad_s2:?}"
        ));
    }
    let [share, decay_1_s, offset_rad_s2] = [share, decay_1_s, offset_rad_s2].map(Vector3::from);
    Ok(Some(RateLaw { share, decay_1_s, offset_rad_s2 }))
}

/// The vehicle that is drafted from the first flight of the logs, which is named as its source, and what is to be known of it.
pub(super) fn drafted(given: Given, logs: &[Vec<Flight>]) -> Result<(Contender, Vec<Note>), StudyError> {
    let known = VehicleGiven::Weighed(given).of_flights(None, logs)?;
    let notes = known.notes();
    let path = text::path(&known.origin);
    let first = logs.iter().flatten().next();
    let sha256 = first.map_or_else(String::new, |flight| flight.input.sha256.clone());
    let input = InputFile { path, sha256, other_logs: Vec::new(), notes: Vec::new() };
    // short enough for the head of a column
    let name = "the draft".to_owned();
    Ok((flying(known.loaded, ValidatedModel { name, input })?, notes))
}

/// Models whose files have one name are called by their paths.
fn tell_apart(models: &mut [Contender], files: &[PathBuf]) {
    let names: Vec<String> = models.iter().map(|model| model.of.name.clone()).collect();
    for ((model, file), name) in models.iter_mut().zip(files).zip(&names) {
        if names.iter().filter(|other| *other == name).count() > 1 {
            model.of.name = text::path(&file);
        }
    }
}
