//! Opens, conditions and identifies; with effects where they are asked for.

use super::request::IdentifyRequest;
use super::result::{IdentifyStudy, WithEffects};
use crate::config::{LoadedVehicle, read_vehicle};
use crate::diagnose::ExplainSettings;
use crate::diagnose::joint::{RequestedEffects, identify_jointly};
use crate::study::flights::{
    Flight, IDENTIFIED, Prepared, file_notes, load_all, names, prepare, refuse_twins,
};
use crate::study::{Progress, Stage, StudyError, effects_of};
use crate::text;

/// Estimates mass and inertia from logs, and the effects that are asked for together with them.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or nothing can be identified.
pub fn identify(request: &IdentifyRequest, progress: &dyn Progress) -> Result<IdentifyStudy, StudyError> {
    request.check()?;
    let wanted = request.requested_effects()?;
    let loaded = read_vehicle(&request.vehicle)?;
    let notes = file_notes(&request.vehicle, &loaded.warnings);
    notes.iter().for_each(|note| progress.note(note));
    progress.stage(Stage::Reading);
    let logs = load_all(&request.logs, &request.read, &IDENTIFIED)?;
    refuse_twins(logs.iter())?;
    progress.stage(Stage::Identifying);
    let with = wanted.map(|wanted| with_effects(request, (&logs, &loaded), &wanted)).transpose()?;
    let vehicle = (&loaded.vehicle, request.vehicle.as_path());
    let Prepared { recordings, signals, inputs } = prepare(logs, vehicle, &request.conditioning())?;
    // memory for the work that begins
    drop(recordings);
    let study = IdentifyStudy::of_signals(signals, inputs, loaded.vehicle, &request.settings())?;
    Ok(IdentifyStudy { with, notes, ..study })
}

/// The named effects together with the rigid body, on the rows on which `explain` would find them.
fn with_effects(
    request: &IdentifyRequest,
    (logs, loaded): (&[Vec<Flight>], &LoadedVehicle),
    wanted: &RequestedEffects,
) -> Result<WithEffects, StudyError> {
    let vehicle = &loaded.vehicle;
    let known = effects_of(&loaded.model.effects, &text::path(&request.vehicle), vehicle)?;
    wanted
        .check_wind(&known)
        .map_err(|error| StudyError::Setting { name: "with", why: error.to_string() })?;
    let settings = request.conditioning_with(wanted);
    let mut flights = Vec::new();
    for log in logs {
        let made = log.iter().map(|flight| flight.conditioned((vehicle, &request.vehicle), &settings));
        let (usable, refused): (Vec<_>, Vec<_>) = made.partition(Result::is_ok);
        if let (true, Some(Err(why))) = (usable.is_empty(), refused.into_iter().next()) {
            return Err(why);
        }
        flights.extend(usable.into_iter().flatten());
    }
    let half_width_s = ExplainSettings::default().half_width_s;
    let together = identify_jointly(&flights, (vehicle, &known), wanted, half_width_s)
        .map_err(|source| StudyError::Joint { logs: names(&request.logs), source })?;
    Ok(WithEffects { together, quality: flights.into_iter().map(|signals| signals.quality).collect() })
}
