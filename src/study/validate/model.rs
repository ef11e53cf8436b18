//! The models that are compared.

use std::path::{Path, PathBuf};

use super::result::ValidatedModel;
use crate::config::{LoadedVehicle, read_vehicle};
use crate::note::Note;
use crate::physics::Model;
use crate::study::flights::file_notes;
use crate::study::{InputFile, Progress, StudyError, effects_of, with_stated_lag};
use crate::text;
use crate::vehicle::Vehicle;

/// A model, ready to fly.
pub(super) struct Contender {
    pub(super) of: ValidatedModel,
    pub(super) vehicle: Vehicle,
    pub(super) model: Model,
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
        models.push(contender(file, loaded)?);
    }
    tell_apart(&mut models, files);
    Ok((models, notes))
}

fn contender(file: &Path, loaded: LoadedVehicle) -> Result<Contender, StudyError> {
    let effects = effects_of(&loaded.model.effects, &text::path(&file), &loaded.vehicle)?;
    let effects = with_stated_lag(effects, &loaded.vehicle);
    let model = Model::new(&loaded.vehicle, effects)
        .map_err(|error| StudyError::File { file: text::path(&file), why: error.to_string() })?;
    let name = file.file_stem().map_or_else(|| loaded.vehicle.name.clone(), |stem| text::path(&stem));
    let of = ValidatedModel { name, input: InputFile::of(file)? };
    Ok(Contender { of, vehicle: loaded.vehicle, model })
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
