//! Flights that are ready: held out, explained, shown, and explained again where that is called for.

use super::along::{with_own, with_own_winds, without_gust_of_none};
use super::doubts::{of_bent_scale, of_voltage};
use super::hold_out::hold_back;
use super::limited::{FlightLimit, limits_of_flights};
use super::refuted::BetterBy;
use super::result::{ExplainStudy, Given};
use super::short::Short;
use super::taken_back::{gone_with, tell_gone};
use super::traces::traces_of;
use super::validation_data::ValidationData;
use crate::diagnose::holdout::split_last_periods;
use crate::diagnose::holdout::{Agreement, HoldoutSettings};
use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{
    ExplainError, ExplainSettings, Explanation, GyroscopicShare, Named, Need, TorqueLaw, Verdict,
};
use crate::estimate::{
    Contradiction, NAMES, contradicted, contradicting_flights, contradicts_file, moved_by_guessed_curve,
};
use crate::note::Note;
use crate::signals::{Signals, airborne_voltage_v, hover_command};
use crate::study::flights::{Prepared, names};
use crate::study::{Progress, Stage, StudyError};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::cell::OnceCell;
use std::path::PathBuf;

/// Why a whole flight is explained.
const CHANGES_LATE: &str = "something changes in the part that would be held back, so the whole flight is explained; \
                            give another flight with --holdout";

/// What is asked of the flights.
#[derive(Clone, Copy)]
pub(in crate::study) struct Asked<'a> {
    /// nominal
    pub(in crate::study) vehicle: &'a Vehicle,
    /// what is to be said of the data before anything else
    pub(in crate::study) notes: &'a [Note],
    /// the files that the flights came from
    pub(in crate::study) logs: &'a [PathBuf],
    /// s left out at the beginning of each flight
    pub(in crate::study) transient_s: f64,
}

/// Names what the model leaves out, and shows the model with it on `held`, on each flight by the others, or on the end of the only one.
/// Where something changes at the very end, the whole flight is explained. Afterwards `flights` hold what was explained.
///
/// # Errors
/// [`StudyError::Explain`] where the flights cannot be explained.
pub(in crate::study) fn explain_prepared(
    flights: &mut Prepared,
    held: &mut Prepared,
    asked: Asked,
    progress: &dyn Progress,
) -> Result<ExplainStudy, StudyError> {
    // the wind of one flight is for its explanation to name
    let several = flights.signals.len() > 1;
    let flown_hover = hover_command(&flights.signals, asked.vehicle);
    let winds_m_s = if several { with_own_winds(flights, asked.vehicle) } else { Vec::new() };
    let held_winds_m_s = if several { with_own_winds(held, asked.vehicle) } else { Vec::new() };
    let alone = if several { with_own(flights, asked.vehicle) } else { Vec::new() };
    let limited = limits_of_flights(&flights.signals, asked.vehicle);
    let whole = flights.signals.last().cloned();
    let (shown_on, back) = match (held.is_empty(), several) {
        (true, true) => (ValidationData::LeftOut { flights: flights.signals.len() }, None),
        (true, false) => hold_back(flights),
        (false, _) => (ValidationData::Flights(held.inputs.clone()), None),
    };
    let is_short = matches!(shown_on, ValidationData::Nothing { .. });
    let usable_s = flights.signals.iter().map(|signals| signals.quality.usable.usable_s).sum();
    let short = is_short.then_some(Short { usable_s, unsure: Vec::new() });
    let mut task = Task {
        asked,
        winds_m_s: &winds_m_s,
        flown_hover,
        limited,
        alone: &alone,
        short,
        held_airs: OnceCell::new(),
        progress,
    };
    progress.stage(Stage::Explaining);
    let (mut study, mut refused) = task.explained(flights, (held, back.as_ref(), shown_on.clone()))?;
    // payload and wind of another day make no other vehicle; the names stay as they were found
    let is_foreign = |study: &ExplainStudy| {
        study.other_vehicle().is_some() && matches!(study.shown_on, ValidationData::Flights(_))
    };
    if study.refuted.is_none() && is_foreign(&study) && !study.is_rotor_apart() {
        progress.stage(Stage::Predicting);
        let day = !several && !names_wind(&study);
        let own_winds = if day { with_own_winds(held, asked.vehicle) } else { Vec::new() };
        if let Some(mut own) = task.with_own_load(&study, flights, (held, &shown_on)) {
            let settings = own.given.settings.clone();
            let traces = |signals: &[Signals]| traces_of(signals, asked.vehicle, &settings);
            let both = || [traces(&flights.signals), traces(&held.signals)];
            own.tell_rotor_apart(both);
            study = own;
            study.tell_winds(&held.inputs, &own_winds);
        }
    }
    // a hold-out of another vehicle tests no name of a short flight
    let no_part = || flights.signals.iter().all(|signals| split_last_periods(signals).is_none());
    if is_foreign(&study) && !several && no_part() {
        task.short = Some(Short { usable_s, unsure: Vec::new() });
        (study, refused) = task.judged_as_short((study, refused), flights, (held, shown_on))?;
    }
    study.notes.extend(refused);
    study.tell_winds(&held.inputs, &held_winds_m_s);
    if let Some(airs) = task.held_airs.get().and_then(Option::as_ref).filter(|_| study.given.own_wind) {
        study.tell_winds(&held.inputs, &airs.iter().map(|air| Some([air.x, air.y])).collect::<Vec<_>>());
    }
    // what changed in the part held back, or shortly before it, is nowhere in the part explained
    match whole.filter(|_| back.is_some() && changes_late(&study)) {
        Some(whole) => task.explained_again(study, flights, whole),
        None => Ok(study),
    }
}

/// What every attempt has in common.
pub(super) struct Task<'a> {
    pub(super) asked: Asked<'a>,
    /// of each flight, where they are several
    pub(super) winds_m_s: &'a [Option<[f64; 2]>],
    /// command of the flown hover with its standard error, of the flights before any wind was taken out of them
    flown_hover: Option<(f64, f64)>,
    /// why the flights tell little, with the parts that are held back
    limited: Vec<FlightLimit>,
    /// of each flight, where they are several and not alike
    alone: &'a [Vec<Named>],
    /// where one flight is given, no part of it can be held back, and no hold-out is of its vehicle
    pub(super) short: Option<Short>,
    /// wind of each hold-out, world, m/s, once it was asked for; `None` where they do not tell
    pub(super) held_airs: OnceCell<Option<Vec<Vector3<f64>>>>,
    pub(super) progress: &'a dyn Progress,
}

impl Task<'_> {
    /// Explains the flights and shows the better model; what is to be said of the data before comes first. An effect without which the
    /// hold-out is predicted better is left out, and the flights are explained again.
    pub(super) fn explained(
        &self,
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, ValidationData),
    ) -> Result<(ExplainStudy, Vec<Note>), StudyError> {
        let mut settings = ExplainSettings::default();
        let (mut notes, mut unsure) = (Vec::new(), Vec::<(&str, String)>::new());
        let mut withdrawn = Vec::<(&str, String)>::new();
        let mut all_was_explained = false;
        loop {
            let mut explanation = self.explanation(flights, &settings)?;
            if self.short.is_some() {
                // a short flight does not tell wind that is irregular from anything else
                explanation = explanation.without_gust();
            }
            if unsure.is_empty() {
                all_was_explained = explanation.verdict == Verdict::Explained;
            } else if all_was_explained {
                explanation = explanation.of_unsure_cause();
            }
            self.progress.stage(Stage::Predicting);
            let given = self.given(flights, settings.clone());
            let (mut study, in_own_wind) = self.shown(given, explanation, flights, (held, back, &shown_on));
            let held = in_own_wind.as_ref().unwrap_or(held);
            let traces = || traces_of(&flights.signals, self.asked.vehicle, &settings);
            study.tell_rotor_apart(|| [traces(), traces_of(&held.signals, self.asked.vehicle, &settings)]);
            let worthless = study.worthless().filter(|of| !settings.refused.contains(&of.id));
            let worthless = worthless.or_else(|| study.unsupported());
            let refuted = study.refuted_by_holdout();
            let is_refuted = refuted.is_some();
            // one of several that does harm leaves first: what is left is judged again
            let leaves_first = worthless.is_some() && study.explanation.named.len() > 1;
            if let Some(refuted) = refuted.filter(|_| !leaves_first) {
                let (given, explanation) = study.into_found();
                study = self.evaluated(given, explanation.refuted(), flights, (held, back, shown_on));
                study.notes.push(refuted.note());
                study.refuted = Some(refuted);
                return Ok((study, notes));
            }
            let unshown = if is_refuted { None } else { study.unshown(&traces()) };
            let is_unshown = unshown.is_some();
            let (id, note) = match (unshown, worthless) {
                (Some(of), _) => {
                    let more = (of.id, of.note());
                    unsure.push((of.id, of.name));
                    more
                }
                // what is in one flight alone may stand behind it, and is looked for again
                (None, Some(of)) if of.by == BetterBy::NoFlight => {
                    settings.refused.push(of.id);
                    notes.push(of.note());
                    continue;
                }
                (None, Some(of)) => {
                    let more = (of.id, of.note());
                    withdrawn.push((of.id, of.name));
                    more
                }
                (None, None) => {
                    tell_gone(&mut study, unsure, withdrawn);
                    return Ok((study, notes));
                }
            };
            let gone = gone_with((id, is_unshown), &study, &settings);
            settings.refused.extend(gone);
            notes.push(note);
            self.progress.stage(Stage::ExplainingAgain);
        }
    }

    /// An explanation on hold-outs, with their own wind and mass where that counts; the hold-outs as they are seen then.
    fn shown(
        &self,
        given: Given,
        explanation: Explanation,
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, &ValidationData),
    ) -> (ExplainStudy, Option<Prepared>) {
        let study = self.evaluated(given, explanation, flights, (held, back, shown_on.clone()));
        let (study, in_own_wind) = self.with_own_wind(study, flights, (held, shown_on));
        let held = in_own_wind.as_ref().unwrap_or(held);
        (self.with_own_mass(study, flights, (held, shown_on)), in_own_wind)
    }

    fn explanation(&self, flights: &Prepared, settings: &ExplainSettings) -> Result<Explanation, StudyError> {
        let tell = |done, of| self.progress.about(done, of);
        let found = crate::diagnose::explain_watched(&flights.signals, self.asked.vehicle, settings, &tell)
            .map_err(|source| self.unexplained(flights, source))?;
        Ok(without_gust_of_none(found, &flights.signals, self.alone, (self.asked.vehicle, settings)))
    }

    /// Why flights cannot be explained; that the vehicle is another one's is said first, because then less of them can be used.
    fn unexplained(&self, flights: &Prepared, source: ExplainError) -> StudyError {
        let is_short = matches!(source, ExplainError::TooShort { .. });
        let apart = if is_short { contradicted(&flights.signals, self.asked.vehicle) } else { Vec::new() };
        let mismatch =
            contradicts_file(&apart).map(|apart| format!("{apart} (is it another vehicle's?); with it "));
        StudyError::Explain {
            logs: names(self.asked.logs),
            mismatch: mismatch.unwrap_or_default(),
            source: Box::new(source),
        }
    }

    pub(super) fn given(&self, flights: &Prepared, settings: ExplainSettings) -> Given {
        // what a flight has its own is known, and no doubt
        let own = |flight: usize| flights.signals.get(flight).is_some_and(|signals| !signals.own.is_none());
        let mut contradicting = contradicting_flights(&flights.signals, self.asked.vehicle);
        contradicting.retain(|apart| !own(apart.flight) && !own(0));
        // a hover in moving air is none to who moves with it
        let of_one = || hover_command(&flights.signals, self.asked.vehicle);
        let hover_command = if flights.signals.len() > 1 { self.flown_hover } else { of_one() };
        Given {
            vehicle: self.asked.vehicle.clone(),
            inputs: flights.inputs.clone(),
            quality: flights.signals.iter().map(|signals| signals.quality.clone()).collect(),
            battery_voltage_v: airborne_voltage_v(&flights.signals),
            hover_command,
            by_guessed_curve: moved_by_guessed_curve(&flights.signals, self.asked.vehicle),
            contradicting,
            limited: self.limited.clone(),
            has_velocity: flights.signals.iter().any(|one| one.velocity.is_some() && one.attitude.is_some()),
            settings,
            transient_s: self.asked.transient_s,
            own_load: false,
            own_wind: false,
        }
    }

    /// An explanation with what it does on the flights explained and on those held out. An empirical force with which these are predicted
    /// worse is left out.
    pub(super) fn evaluated(
        &self,
        given: Given,
        explanation: Explanation,
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, ValidationData),
    ) -> ExplainStudy {
        let on = (held, back, shown_on.clone());
        let study = self.evaluated_with((given, explanation), flights, on, false);
        let Some(refuted) = study.refuted_force() else { return study };
        let (given, explanation) = study.into_found();
        let mut without = self.evaluated_with((given, explanation), flights, (held, back, shown_on), true);
        without.notes.push(refuted.note());
        without.left_out_force = Some(refuted);
        without
    }

    /// The same with an empirical force where no mechanism serves, or with that `left_out`.
    fn evaluated_with(
        &self,
        (given, explanation): (Given, Explanation),
        flights: &Prepared,
        (held, back, shown_on): (&Prepared, Option<&Signals>, ValidationData),
        left_out: bool,
    ) -> ExplainStudy {
        let mut study = ExplainStudy::new(given, explanation);
        study.short = self.short.clone();
        study.notes.extend_from_slice(self.asked.notes);
        let contradictions = study.contradictions();
        study.notes.extend(contradictions.iter().map(Contradiction::note));
        study.tell_mass();
        study.tell_shape();
        study.notes.extend(study.explanation.named.iter().filter_map(of_voltage).collect::<Vec<_>>());
        study.notes.extend(of_bent_scale(study.fitted(), &study.given.vehicle));
        study.notes.extend(study.explanation.torque_law.iter().map(TorqueLaw::note));
        study.notes.extend(study.gyroscopic().iter().map(GyroscopicShare::note));
        study.tell_wandering();
        if flights.signals.len() > 1 {
            study.tell_along(&flights.signals, self.winds_m_s.to_vec(), self.alone);
        }
        study.tell_flights_apart();
        study.evaluate_explained(flights, left_out);
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
        let (mut of_whole, refused) = self.explained(flights, (&Prepared::default(), None, shown_on))?;
        of_whole.notes.extend(refused);
        if changes(&of_whole).any(|id| changes(&of_part).all(|of| of != id)) {
            return Ok(of_whole);
        }
        if let Some(last) = flights.signals.last_mut() {
            *last = part;
        }
        Ok(of_part)
    }
}

/// The part held back is another's, or what is left of the part explained drifts with time. Or its mass is another one, as after a drop
/// shortly before: the part explained then has a mass between both, and its standard error hides the difference.
fn changes_late(study: &ExplainStudy) -> bool {
    let drifts =
        study.located.state.iter().any(|state| ["time", "voltage"].contains(&state.variable.as_str()));
    let is_mass = |of: &&Agreement| of.name == NAMES[0];
    let mass = study.shown.iter().flat_map(|shown| &shown.agreement).find(is_mass);
    let drops = mass.is_some_and(|of| of.share().abs() > DROP_SHARE && of.sigmas().abs() > DROP_SIGMAS);
    study.other_vehicle().is_some() || drops || (study.verdict() == Verdict::Unexplained && drifts)
}

/// Share of the mass, and standard errors, from which on a drop is looked for in the whole flight. Only what is looked for depends on both:
/// a name has its own conditions.
const DROP_SHARE: f64 = 0.02;
const DROP_SIGMAS: f64 = 3.0;

/// The wind of the flight that was explained is in the model.
fn names_wind(study: &ExplainStudy) -> bool {
    let mut terms = study.explanation.search.after.base.effects.iter();
    terms.any(|term| term.signature.role.of_the_day)
}

/// The names that begin at an instant, or that grow over the flight as the battery empties.
fn changes(study: &ExplainStudy) -> impl Iterator<Item = &'static str> {
    let changes =
        |signature: &Signature| signature.role.moment.is_some() || signature.needs.contains(&Need::Voltage);
    let named = study.effects.iter().map(|named| named.id);
    named.filter(move |id| signature_of(id).is_some_and(changes))
}
