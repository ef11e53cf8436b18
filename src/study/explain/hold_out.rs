//! What the better model is shown on, and how it does there.

use super::left_out::{of_others, shown_only_by};
use super::left_out_force::{LeftOutForce, WORSE_PERCENT};
use super::refuted::{BetterBy, Refuted, Worthless};
use super::result::ExplainStudy;
use super::validation_data::ValidationData;
use crate::diagnose::holdout::{
    Explained, HeldOut, HoldoutError, HoldoutFit, HoldoutSettings, IdentificationFit, Split, differing,
    on_holdout, on_identification, on_left_out, split_last_periods,
};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{Empirical, Named, brief, called};
use crate::note::{About, Note};
use crate::signals::{Signals, clock_offset};
use crate::study::flights::Prepared;
use crate::study::same_flight::shared;
use crate::study::{Predicted, StudyError};

/// What a law of the rates is.
const BY_RATE_LAW: &str = "over 0.5 s, a constant state predicts body rates or attitude better than the model: calm \
                           flight under a controller says little about torques. Open-loop \
                           predictions use an empirical law of the rates instead (\"rate_law\"). It is valid for this \
                           vehicle under this controller and is no property of the vehicle. model.toml has \
                           it below [identified.rate_law], and `mavid validate` predicts with it. A simulator does not, and \
                           its rates are worse than a constant state. With a trajectory that turns the vehicle more (`mavid plan`), the torques can be compared";

/// Names serve where they lower the errors over 0.5 s of how a vehicle moves, or of how it turns, by more, percent. Set by judgement: chance
/// does not do this on data that were not used.
const HELPS_PERCENT: f64 = 10.0;

/// Mean over the quantities of how much smaller errors over 0.5 s have to be without an effect. The model without it has the other
/// parameters of the model with it, which speaks for the effect; predictions are repeated to a tenth of this.
pub(super) const LEAST_BETTER_PERCENT: f64 = 1.0;

/// Mean over the quantities of motion by which errors over 0.5 s have to be smaller with a model that follows the height than with the better
/// baseline. On an indoor flight of a real vehicle, whose thrust drifts, two searches that differ by rounding gave -38 and 0.1 %. Set by judgement.
const BY_HEIGHT_PERCENT: f64 = 5.0;

/// Largest chance of such errors of an effect that is worth nothing. A fifth, and no less: of what is worth nothing, nothing may be
/// named, and a part that is held back has few blocks. What is worth something has larger errors without it, and is refused far more
/// seldom. Set by judgement.
const BY_CHANCE: f64 = 0.2;

/// Least mean speed of another flight, as a share of that of the flights explained, with which it refutes what acts in motion. With half
/// the speed a linear drag has half the force, and that by the square a quarter. Set by judgement.
const MOVES: f64 = 0.5;

/// A flight that was used, or a part of it, shows nothing as a hold-out.
pub(super) fn refuse_shared(flights: &Prepared, held: &Prepared) -> Result<(), StudyError> {
    for (hold_out, input) in held.recordings.iter().zip(&held.inputs) {
        for (flight, used) in flights.recordings.iter().zip(&flights.inputs) {
            if let Some(share) = shared(hold_out, flight) {
                let why = format!(
                    "expected a flight that is not explained, but {:.0} % of {} are in {} as well",
                    100.0 * share,
                    input.path,
                    used.path
                );
                return Err(StudyError::Setting { name: "holdout", why });
            }
            if clock_offset(flight, hold_out).is_some() {
                let why = format!(
                    "expected a flight that is not explained, but {} is another log of the flight of {}: give both logs as one \
                     flight, without --holdout",
                    input.path, used.path
                );
                return Err(StudyError::Setting { name: "holdout", why });
            }
        }
    }
    Ok(())
}

/// The end of the last flight, which is then not explained.
pub(super) fn hold_back(flights: &mut Prepared) -> (ValidationData, Option<Signals>) {
    let split = flights.signals.last().and_then(split_last_periods);
    let (Some(Split { identify, holdout, from_s, .. }), Some(last)) = (split, flights.signals.last_mut())
    else {
        let reason = "the flight is too short to hold a part of it back; give another with --holdout";
        return (ValidationData::Nothing { reason: reason.to_owned() }, None);
    };
    *last = identify;
    let seconds = holdout.usable.iter().filter(|used| **used).count() as f64 * holdout.grid.step_s;
    (ValidationData::HeldBack { from_s, seconds }, Some(holdout))
}

impl ExplainStudy {
    /// Prediction errors before and after on the flights that were explained, and, of several, whether they are of one
    /// vehicle. An empirical term stands in where no mechanism serves, unless it was `left_out`.
    pub(super) fn evaluate_explained(&mut self, flights: &Prepared, left_out: bool) {
        let (vehicle, settings) = (&self.given.vehicle, &self.given.settings);
        let fit = || Empirical::fit(&self.explanation, &flights.signals, vehicle, settings);
        self.empirical = match if left_out { Ok(None) } else { fit() } {
            Ok(empirical) => empirical,
            Err(error) => {
                self.notes.push(Note::warning(About::Estimate, format!("no empirical term: {error}")));
                None
            }
        };
        let used = flights.held_out();
        let settings = HoldoutSettings::default();
        match on_identification(self.explained(), &used, vehicle, &settings) {
            Ok(IdentificationFit { open_loop, improvement_percent, rate_law }) => {
                self.identify = Some(Predicted { open_loop, improvement_percent });
                self.rate_law = rate_law;
                self.notes.extend(rate_law.map(|_| Note::warning(About::Estimate, BY_RATE_LAW)));
            }
            Err(error) => {
                self.notes.push(Note::warning(About::Estimate, format!("open-loop prediction: {error}")));
            }
        }
        if used.len() < 2 {
            return;
        }
        match differing(&self.explanation, &used, vehicle, &settings) {
            Ok(why) => {
                self.notes.extend(why.iter().map(|why| Note::warning(About::Estimate, why.as_str())));
                self.differing = why.or(self.differing.take());
            }
            Err(error) => {
                let text = format!("whether the flights are of one vehicle: {error}");
                self.notes.push(Note::warning(About::Estimate, text));
            }
        }
    }

    /// What speaks against the names: with them, flights that were not used are predicted worse. `None` where they help, and where
    /// the hold-out is of another vehicle.
    pub(super) fn refuted_by_holdout(&self) -> Option<Refuted> {
        let named = self.explanation.named.iter();
        if !self.explanation.named.iter().all(|named| self.judges(named.id)) {
            return None;
        }
        let worse_percent = -self.holdout.as_ref()?.work_of_effects()?;
        let names: Vec<String> = named.map(|named| brief(named, &self.given.vehicle, true)).collect();
        // what explains how it moves is not refuted by how it turns, and the other way round
        let helps = self.holdout.as_ref()?.better_work_of_effects().is_some_and(|work| work > HELPS_PERCENT);
        let refuted = worse_percent > 0.0 && !helps && !names.is_empty() && self.other_vehicle().is_none();
        refuted.then_some(Refuted { names, worse_percent })
    }

    /// The named effect that flights which were not used do not confirm: they are predicted better without it, by most and by more than
    /// chance, or it follows the height alone and the model does not predict clearly better than a baseline. `None` where there is no such effect, where
    /// the hold-out is of another vehicle, and where the wind of the explained flights was another one.
    pub(super) fn worthless(&self) -> Option<Worthless> {
        let worth = self.worth.as_ref().filter(|worth| !worth.on_explained)?;
        let same_flight = matches!(self.shown_on, ValidationData::HeldBack { .. });
        let terms = &self.explanation.search.after.base.effects;
        if self.other_vehicle().is_some()
            || !(same_flight || self.given.own_wind)
                && terms.iter().any(|term| term.signature.role.of_the_day)
        {
            return None;
        }
        // a lag has its delay in its place, and a moment is looked for again
        let is_judged = |id: &str| {
            signature_of(id).is_some_and(|of| of.role.latency.is_none() && of.role.moment.is_none())
                && self.judges(id)
        };
        let of = |named: &Named| {
            let better_percent = worth.better_without_percent(named.id)?;
            // where there are too few blocks for a test, the mean decides in the same flight, and nothing in another one
            let chance = worth.chance_of_better_without(named.id).or((!same_flight).then_some(1.0));
            if chance.is_some_and(|chance| chance > BY_CHANCE) {
                return None;
            }
            let name = brief(named, &self.given.vehicle, true);
            Some(Worthless { id: named.id, name, better_percent, by: BetterBy::Without })
        };
        let judged = self.explanation.named.iter().filter(|named| is_judged(named.id)).filter_map(of);
        judged
            .filter(|of| of.better_percent > LEAST_BETTER_PERCENT)
            .max_by(|a, b| a.better_percent.total_cmp(&b.better_percent))
            .or_else(|| self.drifts_with_height())
    }

    /// A named effect that follows the height alone, where the model does not predict the hold-out clearly better than a baseline. A thrust
    /// that drifts during a flight follows its height by chance, and what is outside the vehicle needs more than the flight in which it was
    /// found.
    fn drifts_with_height(&self) -> Option<Worthless> {
        let better_percent = -self.holdout.as_ref()?.improvement_in_motion()?;
        let by_height = |named: &&Named| {
            signature_of(named.id).is_some_and(|of| of.naming.by_height) && self.judges(named.id)
        };
        let named =
            self.explanation.named.iter().find(by_height).filter(|_| better_percent > -BY_HEIGHT_PERCENT)?;
        let name = brief(named, &self.given.vehicle, true);
        Some(Worthless { id: named.id, name, better_percent, by: BetterBy::Baseline })
    }

    /// Whether the hold-out can refute an effect: another flight that hardly moves tells nothing of what acts in motion.
    fn judges(&self, id: &str) -> bool {
        let by_motion = signature_of(id).is_none_or(|of| of.role.by_motion);
        let moves = self.shown.as_ref().is_none_or(|shown| shown.speed_share > MOVES);
        !by_motion || moves || !matches!(self.shown_on, ValidationData::Flights(_))
    }

    /// Whether a hold-out is predicted over half a second.
    pub(super) fn predicts(&self) -> bool {
        self.holdout.as_ref().is_some_and(|holdout| holdout.improvement().is_some())
    }

    /// What predicts.
    pub(super) fn explained(&self) -> Explained<'_> {
        let (explanation, empirical) = (&self.explanation, self.empirical.as_ref());
        Explained { explanation, empirical, rate_law: self.rate_law }
    }

    /// The same on flights that were not used, or on the part held back.
    pub(super) fn evaluate_held_out(
        &mut self,
        held: &Prepared,
        back: Option<&Signals>,
        shown_on: ValidationData,
    ) {
        let mut flights = held.held_out();
        flights.extend(back.map(|signals| HeldOut { name: "the part held back", signals, recording: None }));
        if flights.is_empty() {
            self.shown_on = shown_on;
        } else if let Err(error) = self.evaluate_on(&flights, shown_on) {
            self.notes.push(Note::warning(About::HoldOut, format!("hold-out: {error}")));
            self.shown_on = ValidationData::Nothing { reason: error.to_string() };
        }
    }

    /// The same on each flight that was explained, by models of the others.
    pub(super) fn evaluate_left_out(&mut self, flights: &Prepared) {
        let settings = HoldoutSettings { own_mass: true, ..HoldoutSettings::default() };
        let (mut predicted, mut each, mut alone) = (Vec::new(), Vec::new(), Vec::new());
        let models = of_others(self, &flights.signals);
        for ((place, flight), explanation) in flights.held_out().into_iter().enumerate().zip(&models) {
            match shown_only_by(self, place, &flight.signals.own) {
                Some(id) => alone.push(format!("{} is shown by {} alone", called(id), flight.name)),
                None => {
                    predicted.push(flight);
                    each.push(Explained { explanation, ..self.explained() });
                }
            }
        }
        if predicted.is_empty() {
            let reason = format!("no flight can be predicted by the others: {}", alone.join("; "));
            self.shown_on = ValidationData::Nothing { reason };
            return;
        }
        let shown_on = ValidationData::LeftOut { flights: predicted.len() };
        let shown = on_left_out(self.explained(), &each, &predicted, (&self.given.vehicle, &settings));
        self.notes.extend(alone.iter().map(|of| {
            let text = format!("{of}, so the others do not predict this flight");
            Note::remark(About::HoldOut, text)
        }));
        match shown {
            Ok(shown) => self.take_prediction(shown, shown_on),
            Err(error) => {
                self.notes.push(Note::warning(About::HoldOut, format!("hold-out: {error}")));
                self.shown_on = ValidationData::Nothing { reason: error.to_string() };
            }
        }
    }

    fn evaluate_on(&mut self, flights: &[HeldOut], shown_on: ValidationData) -> Result<(), HoldoutError> {
        let same_flight = matches!(shown_on, ValidationData::HeldBack { .. });
        let (own_mass, own_wind) = (self.given.own_load, self.given.own_wind);
        let settings = HoldoutSettings { same_flight, own_mass, own_wind, ..HoldoutSettings::default() };
        let shown = on_holdout(self.explained(), flights, &self.given.vehicle, &settings)?;
        self.take_prediction(shown, shown_on);
        self.measure_worth(flights, false, &settings);
        Ok(())
    }

    fn take_prediction(&mut self, shown: HoldoutFit, shown_on: ValidationData) {
        let other = shown.other_vehicle.iter();
        self.notes.extend(other.map(|other| Note::warning(About::HoldOut, other.reason.clone())));
        self.holdout = Some(Predicted::from(&shown));
        self.without_empirical = (!shown.without_empirical.is_empty())
            .then(|| Predicted { open_loop: shown.without_empirical.clone(), improvement_percent: None });
        self.as_written = (!shown.as_written.is_empty())
            .then(|| Predicted { open_loop: shown.as_written.clone(), improvement_percent: None });
        self.shown = Some(shown);
        self.shown_on = shown_on;
    }

    /// The empirical force, where flights that were not used are predicted clearly worse with it than without it. `None` where there is
    /// none, and where the hold-out is of another vehicle.
    pub(super) fn refuted_force(&self) -> Option<LeftOutForce> {
        let along = self.empirical.as_ref()?.along;
        if self.other_vehicle().is_some() {
            return None;
        }
        let with = self.holdout.as_ref()?.half_second();
        let without = self.without_empirical.as_ref()?.half_second();
        let each = with.iter().zip(&without).filter_map(|(with, without)| {
            let percent = 100.0 * (with.as_ref()?.after.value / without.as_ref()?.after.value - 1.0);
            percent.is_finite().then_some(percent)
        });
        let each: Vec<f64> = each.collect();
        let worse_percent = each.iter().sum::<f64>() / each.len().max(1) as f64;
        (worse_percent > WORSE_PERCENT).then_some(LeftOutForce { along, worse_percent })
    }
}
