//! Opens, conditions, holds out, explains, tries again, shows, and designs the next flight.

use super::hold_out::refuse_shared;
use super::limited::saturated;
use super::prepared::{Asked, explain_prepared};
use super::request::ExplainRequest;
use super::result::ExplainStudy;
use super::traces::traces_of;
use crate::config::effects_of;
use crate::config::{LoadedVehicle, read_limits};
use crate::diagnose::experiment::{NextSettings, design};
use crate::draft::Draft;
use crate::note::{About, Note, said_once};
use crate::signals::{ConditionSettings, STEP_FOR_EFFECTS_S, Signals, ThrustPreference, other_settings};
use crate::study::flights::{EXPLAINED, Prepared, load_all, prepare, prepare_by_motion, refuse_off_mixer};
use crate::study::one_vehicle::refuse_other_builds;
use crate::study::same_flight::{refuse_same_flight, refuse_twins};
use crate::study::unflown::unflown_first;
use crate::study::vehicle_given::Known;
use crate::study::{Progress, Stage, StudyError, lost};
use crate::text;
use crate::vehicle::Vehicle;

/// What a recording without velocity cannot tell.
const NO_VELOCITY: &str = "no velocity (LOCAL_POSITION_NED or similar), or no attitude, is recorded: drag, wind and \
                           other effects of the air cannot be tested, and a named effect may be a substitute for \
                           their effect on the rotation";

/// Names the physics that the vehicle's file leaves out.
///
/// Reads and conditions the logs, holds out flights or the end of the last one, searches effects, and shows the model
/// with them on what was held out. Where something changes at the very end, the whole flight is explained instead.
///
/// # Errors
/// [`StudyError`] where a file or a setting cannot be used, or no flight can be explained.
pub fn explain(request: &ExplainRequest, progress: &dyn Progress) -> Result<ExplainStudy, StudyError> {
    request.check()?;
    let known = request.vehicle.of_file()?;
    // a file that cannot be used is told before the work
    let next_limits = request.next_limits.as_deref().map(read_limits).transpose()?;
    progress.stage(Stage::Reading);
    let mut logs = load_all(&request.logs, &request.read, &EXPLAINED)?;
    request.vehicle.own_units(&mut logs);
    refuse_other_builds(logs.iter().flatten())?;
    let or_unflown = |error| unflown_first(error, &request.logs, &request.read);
    let known = request.vehicle.of_flights(known, &logs).map_err(or_unflown)?;
    let mut notes = of_vehicle(&known)?;
    let Known { loaded: LoadedVehicle { mut vehicle, .. }, origin, mut draft, .. } = known;
    let name = vehicle.name.clone();
    let of_holdout =
        |why| StudyError::Setting { name: "holdout", why: format!("expected a flight of {name}: {why}") };
    let mut held = load_all(&request.holdout, &request.read, &EXPLAINED).map_err(of_holdout)?;
    request.vehicle.own_units(&mut held);
    refuse_twins(logs.iter().chain(&held))?;
    refuse_same_flight(logs.iter())?;
    refuse_same_flight(held.iter())?;
    refuse_other_builds(logs.iter().chain(&held).flatten())?;
    refuse_off_mixer(logs.iter().chain(&held))?;
    progress.stage(Stage::Conditioning);
    let settings = ConditionSettings {
        transient_s: Some(request.transient_s),
        thrust: ThrustPreference::BestSampled,
        least_step_s: STEP_FOR_EFFECTS_S,
        ..ConditionSettings::default()
    };
    let (mut flights, corrected) =
        prepare_by_motion(logs, (&vehicle, &origin), &settings).map_err(or_unflown)?;
    if let Some(corrected) = corrected {
        notes.extend(take_corrected(corrected, &mut vehicle, draft.as_mut()));
    }
    let mut held = prepare(held, (&vehicle, &origin), &settings).map_err(of_holdout)?;
    refuse_shared(&flights, &held)?;
    notes.extend(other_settings(&flights.recordings));
    notes.extend(of_data(&flights, &held));
    let of =
        Asked { vehicle: &vehicle, notes: &notes, logs: &request.logs, transient_s: request.transient_s };
    let mut study = explain_prepared(&mut flights, &mut held, of, progress)?;
    study.traces = traces_of(&flights.signals, &vehicle, &study.given.settings);
    study.drafted = draft;
    if request.design_next {
        study.tell_by_part();
        progress.stage(Stage::Designing);
        let inside = Vehicle { limits: next_limits.unwrap_or(vehicle.limits), ..vehicle.clone() };
        let settings = NextSettings::default();
        progress.steps(settings.work());
        let step = || progress.step();
        study.next_flight = Some(design(&study.explanation, &flights.signals, &inside, &settings, &step));
    }
    Ok(study.keeping_about_z())
}

/// Takes the vehicle that the motion allows, also into a draft. Returns what is to be said of it; a warning is among those of the recordings.
fn take_corrected(
    (corrected, why): (Vehicle, Note),
    vehicle: &mut Vehicle,
    draft: Option<&mut Draft>,
) -> Option<Note> {
    if let Some(draft) = draft {
        draft.vehicle = corrected.clone();
        draft.origins.push(why.text.clone());
    }
    *vehicle = corrected;
    Some(why).filter(|why| !why.is_warning())
}

/// What is doubtful about the vehicle's file.
fn of_vehicle(known: &Known) -> Result<Vec<Note>, StudyError> {
    let (loaded, name) = (&known.loaded, text::path(&known.origin));
    let mut notes = known.notes();
    let effects = effects_of(&loaded.model.effects, &name, &loaded.vehicle)?;
    if !effects.is_empty() {
        let ids: Vec<&str> = effects.iter().map(|active| active.effect().id()).collect();
        let text = format!("its effects ({}) are removed and searched for again", ids.join(", "));
        notes.push(Note::warning(About::File(name), text));
    }
    Ok(notes)
}

/// What is to be known of the recordings: what was lost, what is doubtful, what was left out, what is missing.
fn of_data(flights: &Prepared, held: &Prepared) -> Vec<Note> {
    let mut notes = lost(flights.inputs.iter().chain(&held.inputs));
    for (input, signals) in flights.each().chain(held.each()) {
        let about = || About::File(input.path.clone());
        let doubts = signals.quality.notes.iter().filter(|note| note.is_warning());
        notes.extend(doubts.map(|doubt| Note::warning(about(), doubt.text.as_str())));
        let used = &signals.quality.usable;
        if saturated(&signals.quality).is_some() {
            let text = format!(
                "rotors were at a bound of their commands for {:.0} s, which are left out, and {:.0} s are used: \
                 missing physics may then appear under a wrong name; fly a gentler trajectory (mavid plan --limits)",
                used.saturated_s, used.usable_s
            );
            notes.push(Note::warning(about(), text));
        }
    }
    let lacks = |signals: &Signals| signals.velocity.is_none() || signals.attitude.is_none();
    for (input, _) in flights.each().filter(|(_, signals)| lacks(signals)) {
        notes.push(Note::warning(About::File(input.path.clone()), NO_VELOCITY));
    }
    said_once(notes)
}
