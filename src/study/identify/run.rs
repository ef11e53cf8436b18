//! Opens, conditions and identifies; with effects where they are asked for.

use super::joint_estimate::{Found, found_beside};
use super::request::IdentifyRequest;
use super::result::{IdentifyStudy, WithEffects};
use crate::config::effects_of;
use crate::diagnose::ExplainSettings;
use crate::diagnose::joint::{RequestedEffects, identify_jointly};
use crate::note::{About, Note};
use crate::signals::{ConditionSettings, Signals, other_settings};
use crate::study::explain::{Asked, ExplainRequest};
use crate::study::flight::Flight;
use crate::study::flights::{IDENTIFIED, Prepared, load_all, names, prepare, prepare_by_motion};
use crate::study::one_vehicle::refuse_other_builds;
use crate::study::same_flight::refuse_same_flight;
use crate::study::unflown::unflown_first;
use crate::study::vehicle_given::Known;
use crate::study::{InputFile, Progress, Stage, StudyError};
use crate::text;
use crate::vehicle::{Guessed, Vehicle};
use std::path::Path;

/// Estimates mass and inertia from logs, and the effects that are asked for together with them.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or nothing can be identified.
pub fn identify(request: &IdentifyRequest, progress: &dyn Progress) -> Result<IdentifyStudy, StudyError> {
    request.check()?;
    let wanted = request.requested_effects()?;
    let known = request.vehicle.of_file()?;
    progress.stage(Stage::Reading);
    let mut logs = load_all(&request.logs, &request.read, &IDENTIFIED)?;
    request.vehicle.own_units(&mut logs);
    refuse_same_flight(logs.iter())?;
    refuse_other_builds(logs.iter().flatten())?;
    let or_unflown = |error| unflown_first(error, &request.logs, &request.read);
    let mut known = request.vehicle.of_flights(known, &logs).map_err(or_unflown)?;
    let mut notes = known.notes();
    notes.iter().for_each(|note| progress.note(note));
    progress.stage(Stage::Identifying);
    let beside = request.conditioning_beside();
    let of_file = (&known.loaded.vehicle, known.origin.as_path());
    // a guess stays with its error, and what is stated and impossible does not
    let prepared = if known.loaded.vehicle.guessed(Guessed::TorqueRatio) > 0.0 {
        prepare(logs.clone(), of_file, &beside).map(|flights| (flights, None))
    } else {
        prepare_by_motion(logs.clone(), of_file, &beside)
    };
    let (prepared, corrected) = match prepared {
        Ok((flights, corrected)) => (Ok(flights), corrected),
        Err(error) => (Err(error.to_string()), None),
    };
    let contradiction = corrected.map(|(corrected, why)| {
        known.loaded.vehicle = corrected;
        progress.note(&why);
        why
    });
    let with = wanted.map(|wanted| with_effects(request, (&logs, &known), &wanted));
    let with = with.transpose().map_err(or_unflown)?;
    let vehicle = (&known.loaded.vehicle, known.origin.as_path());
    let asked = Asked {
        vehicle: &known.loaded.vehicle,
        notes: &[],
        logs: &request.logs,
        transient_s: beside.transient_s.unwrap_or(ExplainRequest::TRANSIENT_S),
    };
    let found = prepared.and_then(|flights| found_beside(flights, asked, progress));
    let Prepared { recordings, mut signals, inputs, .. } =
        prepare(logs, vehicle, &request.conditioning()).map_err(or_unflown)?;
    tell_contradictions(&mut signals, &found);
    signals.iter_mut().for_each(|signals| signals.quality.notes.extend(contradiction.clone()));
    let apart = other_settings(&recordings);
    apart.iter().for_each(|note| progress.note(note));
    notes.extend(apart);
    // memory for the work that begins
    drop(recordings);
    let lost: Vec<String> = inputs.iter().flat_map(InputFile::losses).collect();
    let study = IdentifyStudy::of_found(signals, inputs, known.loaded.vehicle, &request.settings(), &found)
        .map_err(|error| StudyError::of_estimate(error, &lost))?;
    let study = match &with {
        Some(with) => study.with_law_of(with.joint.torque_law),
        None => study,
    };
    Ok(IdentifyStudy { with, notes, ..study })
}

/// What contradicts the vehicle file may show only where the beginning of the flights is used too, as it is beside effects. One that is
/// told with other figures is told. Nothing where other flights could be used.
fn tell_contradictions(signals: &mut [Signals], found: &Result<Found, String>) {
    let Some(found) = found.as_ref().ok().filter(|found| found.flights.len() == signals.len()) else {
        return;
    };
    let contradicts = |note: &&Note| note.about == About::Contradiction;
    for (signals, seen) in signals.iter_mut().zip(&found.flights) {
        let notes = &mut signals.quality.notes;
        if !notes.iter().any(|note| contradicts(&note)) {
            notes.extend(seen.quality.notes.iter().filter(contradicts).cloned());
        }
    }
}

/// The flights that can be used. The first reason where a log has none.
fn conditioned(
    logs: &[Vec<Flight>],
    vehicle: (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<Vec<Signals>, StudyError> {
    let mut flights = Vec::new();
    for log in logs {
        let made = log.iter().map(|flight| flight.conditioned(vehicle, settings));
        let (usable, refused): (Vec<_>, Vec<_>) = made.partition(Result::is_ok);
        if let (true, Some(Err(why))) = (usable.is_empty(), refused.into_iter().next()) {
            return Err(why);
        }
        flights.extend(usable.into_iter().flatten());
    }
    Ok(flights)
}

/// The named effects together with the rigid body, on the rows on which `explain` would find them.
fn with_effects(
    request: &IdentifyRequest,
    (logs, known): (&[Vec<Flight>], &Known),
    wanted: &RequestedEffects,
) -> Result<WithEffects, StudyError> {
    let vehicle = &known.loaded.vehicle;
    let effects = effects_of(&known.loaded.model.effects, &text::path(&known.origin), vehicle)?;
    wanted
        .check_wind(&effects)
        .map_err(|error| StudyError::Setting { name: "with", why: error.to_string() })?;
    let flights = conditioned(logs, (vehicle, &known.origin), &request.conditioning_with(wanted))?;
    let half_width_s = ExplainSettings::default().half_width_s;
    let joint = identify_jointly(&flights, (vehicle, &effects), wanted, half_width_s)
        .map_err(|source| StudyError::Joint { logs: names(&request.logs), source })?;
    Ok(WithEffects { joint, quality: flights.into_iter().map(|signals| signals.quality).collect() })
}
