//! Hold-outs of another day: with their own wind, and with the mass that they begin with.

use super::along::{airs, beside_wind};
use super::predicted::Predicted;
use super::prepared::Task;
use super::result::{ExplainStudy, Given};
use super::validation_data::ValidationData;
use crate::diagnose::Explanation;
use crate::study::flights::Prepared;

/// A wind that leaves this share of the error that the motion is predicted with is the hold-out's, also where a wrong name still makes the
/// prediction worse than none. Set by judgement.
const HALVED: f64 = 0.5;

impl Task<'_> {
    /// The same with the hold-outs' own wind, where it is told and the motion is predicted better with it, if the effects make that worse with
    /// the wind of the flight explained: another day has another wind.
    pub(super) fn with_own_wind(
        &self,
        study: ExplainStudy,
        flights: &Prepared,
        (held, shown_on): (&Prepared, &ValidationData),
    ) -> (ExplainStudy, Option<Prepared>) {
        let in_motion =
            |study: &ExplainStudy| study.holdout.as_ref().and_then(Predicted::improvement_in_motion);
        let Some(percent) = in_motion(&study).filter(|percent| *percent < 0.0) else { return (study, None) };
        let Some(seen) = self.in_own_wind(held, &study.explanation) else { return (study, None) };
        let given = Given { own_wind: true, ..self.given(flights, study.given.settings.clone()) };
        let own = self.evaluated(given, study.as_found().clone(), flights, (&seen, None, shown_on.clone()));
        if in_motion(&own).is_some_and(|own| own > 0.0 || 100.0 - own < HALVED * (100.0 - percent)) {
            (own, Some(seen))
        } else {
            (study, None)
        }
    }

    /// The same with the mass that a hold-out begins with, where that is another one: what is named is judged by what it does there, and not
    /// by a payload.
    pub(super) fn with_own_mass(
        &self,
        study: ExplainStudy,
        flights: &Prepared,
        (held, shown_on): (&Prepared, &ValidationData),
    ) -> ExplainStudy {
        let begins_so = study.shown.as_ref().is_some_and(|shown| shown.other_mass);
        if !begins_so || !matches!(shown_on, ValidationData::Flights(_)) {
            return study;
        }
        self.loaded(&study, flights, (held, shown_on)).unwrap_or(study)
    }

    /// The same with the load of each hold-out, and its own wind, where the hold-outs are of this vehicle with them.
    pub(super) fn with_own_load(
        &self,
        study: &ExplainStudy,
        flights: &Prepared,
        (held, shown_on): (&Prepared, &ValidationData),
    ) -> Option<ExplainStudy> {
        let in_own_wind = || self.in_own_wind(held, study.as_found());
        let seen = study.given.own_wind.then(in_own_wind).flatten();
        self.loaded(study, flights, (seen.as_ref().unwrap_or(held), shown_on))
    }

    /// The model on hold-outs with the load of each; `None` where it does not predict them, or they are of another vehicle.
    fn loaded(
        &self,
        study: &ExplainStudy,
        flights: &Prepared,
        (held, shown_on): (&Prepared, &ValidationData),
    ) -> Option<ExplainStudy> {
        let (own_wind, settings) = (study.given.own_wind, study.given.settings.clone());
        let given = Given { own_load: true, own_wind, ..self.given(flights, settings) };
        let own = self.evaluated(given, study.as_found().clone(), flights, (held, None, shown_on.clone()));
        (own.predicts() && own.other_vehicle().is_none()).then_some(own)
    }

    /// The hold-outs with their own wind, where the model has that of the one flight that was explained, and they tell theirs.
    pub(super) fn in_own_wind(&self, held: &Prepared, explanation: &Explanation) -> Option<Prepared> {
        let base = &explanation.search.after.base;
        // of several flights, each is seen with its own already
        if held.is_empty()
            || !self.winds_m_s.is_empty()
            || !base.effects.iter().any(|term| term.signature.role.of_the_day)
        {
            return None;
        }
        let airs = self.held_airs.get_or_init(|| airs(held, self.asked.vehicle)).as_ref()?;
        Some(beside_wind(held, airs, &base.wind_m_s()))
    }
}
