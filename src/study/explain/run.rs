//! Opens, conditions, holds out, explains, tries again, shows, and designs the next flight.

use super::along::{with_own, with_own_winds};
use super::hold_out::{hold_back, refuse_shared};
use super::refuted::Worthless;
use super::request::ExplainRequest;
use super::result::{ExplainStudy, Given};
use super::validation_data::ValidationData;
use crate::config::effects_of;
use crate::config::{LoadedVehicle, read_limits};
use crate::diagnose::experiment::{NextSettings, design};
use crate::diagnose::holdout::HoldoutSettings;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{ExplainSettings, Explanation, GyroscopicShare, Named, TorqueLaw, Trace, Verdict};
use crate::estimate::{
    Contradiction, contradicting_flights, inertia_by_wider_window, moved_by_guessed_curve,
};
use crate::note::{About, Note, said_once};
use crate::signals::{ConditionSettings, STEP_FOR_EFFECTS_S, Signals, ThrustPreference, other_settings};
use crate::study::flights::{EXPLAINED, Prepared, load_all, names, prepare, refuse_off_mixer, refuse_twins};
use crate::study::one_vehicle::refuse_other_builds;
use crate::study::unflown::unflown_first;
use crate::study::vehicle_given::Known;
use crate::study::{Progress, Stage, StudyError};
use crate::text;
use crate::vehicle::Vehicle;

/// Share of the flight that may be saturated without a word. Only a warning depends on it.
const SATURATED: f64 = 0.3;
/// What a recording without velocity cannot tell.
const NO_VELOCITY: &str = "no velocity (LOCAL_POSITION_NED or similar), or no attitude, is recorded: drag, wind and \
                           other effects of the air cannot be tested, and a named effect may be a substitute for \
                           their effect on the rotation";
/// Why a whole flight is explained.
const CHANGES_LATE: &str = "something changes in the part that would be held back, so the whole flight is explained; \
                            give another flight with --holdout";

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
    let Known { loaded: LoadedVehicle { vehicle, .. }, origin, draft, .. } = known;
    let of_holdout = |why| StudyError::Setting {
        name: "holdout",
        why: format!("expected a flight of {}: {why}", vehicle.name),
    };
    let mut held = load_all(&request.holdout, &request.read, &EXPLAINED).map_err(of_holdout)?;
    request.vehicle.own_units(&mut held);
    refuse_twins(logs.iter().chain(&held))?;
    refuse_other_builds(logs.iter().chain(&held).flatten())?;
    refuse_off_mixer(logs.iter().chain(&held))?;
    progress.stage(Stage::Conditioning);
    let settings = ConditionSettings {
        transient_s: Some(request.transient_s),
        thrust: ThrustPreference::BestSampled,
        least_step_s: STEP_FOR_EFFECTS_S,
        ..ConditionSettings::default()
    };
    let mut flights = prepare(logs, (&vehicle, &origin), &settings).map_err(or_unflown)?;
    let mut held = prepare(held, (&vehicle, &origin), &settings).map_err(of_holdout)?;
    refuse_shared(&flights, &held)?;
    // the wind of one flight is for its explanation to name
    let several = flights.signals.len() > 1;
    let winds_m_s = if several { with_own_winds(&mut flights, &vehicle) } else { Vec::new() };
    if several {
        with_own_winds(&mut held, &vehicle);
    }
    let alone = if several { with_own(&mut flights, &vehicle) } else { Vec::new() };
    let whole = flights.signals.last().cloned();
    let (shown_on, back) = match (held.is_empty(), several) {
        (true, true) => (ValidationData::LeftOut { flights: flights.signals.len() }, None),
        (true, false) => hold_back(&mut flights),
        (false, _) => (ValidationData::Flights(held.inputs.clone()), None),
    };
    notes.extend(other_settings(&flights.recordings));
    notes.extend(of_data(&flights, &held));
    let task =
        Task { request, vehicle: &vehicle, notes: &notes, winds_m_s: &winds_m_s, alone: &alone, progress };
    progress.stage(Stage::Explaining);
    let mut study = task.explained(&flights, (&held, back.as_ref(), shown_on))?;
    // what changed in the part held back, or shortly before it, is nowhere in the part explained
    if let Some(whole) = whole.filter(|_| back.is_some() && changes_late(&study)) {
        study = task.explained_again(study, &mut flights, whole)?;
    }
    let half_width_s = study.given.settings.half_width_s;
    let traces =
        flights.signals.iter().filter_map(|signals| Trace::new(signals, &vehicle, half_width_s).ok());
    study.traces = traces.collect();
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
    Ok(study)
}

/// What every attempt has in common.
struct Task<'a> {
    request: &'a ExplainRequest,
    vehicle: &'a Vehicle,
    notes: &'a [Note],
    /// of each flight, where they are several
    winds_m_s: &'a [Option<[f64; 2]>],
    /// of each flight, where they are several and not alike
    alone: &'a [Vec<Named>],
    progress: &'a dyn Progress,
}

impl Task<'_> {
    /// Explains the flights and shows the better model; what is to be said of the data before comes first. An effect without which the
    /// hold-out is predicted better is left out, and the flights are explained again.
    fn explained(
        &self,
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, ValidationData),
    ) -> Result<ExplainStudy, StudyError> {
        let mut settings = ExplainSettings::default();
        let mut worthless = Vec::new();
        loop {
            let explanation = self.explanation(flights, &settings)?;
            self.progress.stage(Stage::Predicting);
            let given = self.given(flights, settings.clone());
            let mut study = self.evaluated(given, explanation, flights, (held, back, shown_on.clone()));
            if let Some(refuted) = study.refuted_by_holdout() {
                let ExplainStudy { given, explanation, .. } = study;
                study = self.evaluated(given, explanation.refuted(), flights, (held, back, shown_on));
                study.notes.push(refuted.note());
                study.refuted = Some(refuted);
                return Ok(study);
            }
            let tried = |of: &Worthless| !settings.refused.contains(&of.id);
            let Some(more) = study.worthless().filter(tried) else {
                study.notes.extend(worthless.iter().map(Worthless::note));
                return Ok(study);
            };
            // what would take its place has no more to stand on
            let terms = &study.explanation.search.after.base.effects;
            let stays = |id: &str| id != more.id && terms.iter().any(|term| term.id() == id);
            let ids = settings.signatures.iter().map(|signature| signature.id());
            settings.refused = ids.filter(|id| !stays(id)).collect();
            worthless.push(more);
            self.progress.stage(Stage::ExplainingAgain);
        }
    }

    fn explanation(&self, flights: &Prepared, settings: &ExplainSettings) -> Result<Explanation, StudyError> {
        let tell = |done, of| self.progress.about(done, of);
        crate::diagnose::explain_watched(&flights.signals, self.vehicle, settings, &tell)
            .map_err(|source| StudyError::Explain { logs: names(&self.request.logs), source })
    }

    fn given(&self, flights: &Prepared, settings: ExplainSettings) -> Given {
        // what a flight has its own is known, and no doubt
        let own = |flight: usize| flights.signals.get(flight).is_some_and(|signals| !signals.own.is_none());
        let mut contradicting = contradicting_flights(&flights.signals, self.vehicle);
        contradicting.retain(|apart| !own(apart.flight) && !own(0));
        Given {
            vehicle: self.vehicle.clone(),
            inputs: flights.inputs.clone(),
            quality: flights.signals.iter().map(|signals| signals.quality.clone()).collect(),
            inertia_by_wider_window: inertia_by_wider_window(&flights.signals, self.vehicle),
            by_guessed_curve: moved_by_guessed_curve(&flights.signals, self.vehicle),
            contradicting,
            settings,
            transient_s: self.request.transient_s,
        }
    }

    /// An explanation with what it does on the flights explained and on those held out.
    fn evaluated(
        &self,
        given: Given,
        explanation: Explanation,
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, ValidationData),
    ) -> ExplainStudy {
        let mut study = ExplainStudy::new(given, explanation);
        study.notes.extend_from_slice(self.notes);
        let contradictions = study.contradictions();
        study.notes.extend(contradictions.iter().map(Contradiction::note));
        study.tell_mass();
        study.notes.extend(study.explanation.torque_law.iter().map(TorqueLaw::note));
        study.notes.extend(study.gyroscopic().iter().map(GyroscopicShare::note));
        study.tell_wandering();
        if flights.signals.len() > 1 {
            study.tell_along(&flights.signals, self.winds_m_s.to_vec(), self.alone);
        }
        study.tell_flights_apart();
        study.evaluate_explained(flights);
        if let ValidationData::LeftOut { .. } = shown_on {
            study.evaluate_left_out(flights);
        } else {
            study.evaluate_held_out(held, back, shown_on);
        }
        if study.worth.is_none() {
            study.measure_worth(&flights.held_out(), true, &HoldoutSettings::default());
        }
        study
    }

    /// The whole last flight instead of its part, if that shows a change which the part does not.
    fn explained_again(
        &self,
        of_part: ExplainStudy,
        flights: &mut Prepared,
        whole: Signals,
    ) -> Result<ExplainStudy, StudyError> {
        let Some(last) = flights.signals.last_mut() else { return Ok(of_part) };
        let part = std::mem::replace(last, whole);
        self.progress.stage(Stage::ExplainingAgain);
        let shown_on = ValidationData::Nothing { reason: CHANGES_LATE.to_owned() };
        let of_whole = self.explained(flights, (&Prepared::default(), None, shown_on))?;
        if names_a_change(&of_whole) && !names_a_change(&of_part) {
            return Ok(of_whole);
        }
        if let Some(last) = flights.signals.last_mut() {
            *last = part;
        }
        Ok(of_part)
    }
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
    let mut notes = Vec::new();
    for input in flights.inputs.iter().chain(&held.inputs) {
        let losses = input.losses();
        if !losses.is_empty() {
            notes.push(Note::warning(About::File(input.path.clone()), losses.join("; ")));
        }
    }
    for (input, signals) in flights.each().chain(held.each()) {
        let about = || About::File(input.path.clone());
        let doubts = signals.quality.notes.iter().filter(|note| note.is_warning());
        notes.extend(doubts.map(|doubt| Note::warning(about(), doubt.text.as_str())));
        let used = &signals.quality.usable;
        if !used.saturation_kept && used.saturated_s > SATURATED * (used.usable_s + used.saturated_s) {
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

/// The part held back is another's, or what is left of the part explained drifts with time.
fn changes_late(study: &ExplainStudy) -> bool {
    let drifts =
        study.located.state.iter().any(|state| ["time", "voltage"].contains(&state.variable.as_str()));
    study.other_vehicle().is_some() || (study.verdict() == Verdict::Unexplained && drifts)
}

/// An effect that begins at an instant is among the names.
fn names_a_change(study: &ExplainStudy) -> bool {
    study
        .effects
        .iter()
        .any(|named| signature_of(named.id).is_some_and(|signature| signature.role.moment.is_some()))
}
