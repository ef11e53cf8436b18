//! A rotor that differs in the flights explained alone: between them and the hold-out a propeller or a motor was changed.

use super::hold_out::LEAST_BETTER_PERCENT;
use super::result::ExplainStudy;
use super::validation_data::ValidationData;
use crate::diagnose::holdout::{Difference, OtherVehicle};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{Named, Trace, brief, by_part};
use crate::note::{About, Note};
use crate::text::significant;

/// Standard errors from none by which each part of the flights has to show the difference, far beyond what noise does. Set by judgement.
const BEYOND_DOUBT: f64 = 8.0;
/// Least difference of the rotor (-): a battery that is put back elsewhere, by 2 mm on an arm of 0.15 m, changes the balance by less. Set by
/// judgement.
const LEAST: f64 = 0.03;
/// Standard errors of both within which a part of the hold-out shows none, and beyond which it differs from the flights explained.
const APART: f64 = 4.0;
/// Largest chance of errors that are as much smaller without a rotor that is worth nothing.
const BY_CHANCE: f64 = 0.05;

impl ExplainStudy {
    /// Whether that is why the hold-out is one of another vehicle.
    pub(super) fn is_rotor_apart(&self) -> bool {
        let other = self.shown.as_ref().and_then(|shown| shown.other_vehicle.as_ref());
        other.is_some_and(|other| matches!(other.by, Difference::Rotor { .. }))
    }

    /// Takes hold-outs for those of another vehicle where they are predicted better without a rotor's difference that each part of the flights
    /// explained shows beyond doubt, and that no part of the hold-outs shows. A model without the name would have the difference in its mass
    /// and inertia. `traces` are those of the flights explained and of the hold-outs.
    pub(super) fn tell_rotor_apart(&mut self, traces: impl Fn() -> [Vec<Trace>; 2]) {
        if !matches!(self.shown_on, ValidationData::Flights(_)) || self.other_vehicle().is_some() {
            return;
        }
        // the wind of another day says nothing of a rotor
        let terms = &self.explanation.search.after.base.effects;
        if !self.given.own_wind && terms.iter().any(|term| term.signature.role.of_the_day) {
            return;
        }
        let Some(worth) = self.worth.as_ref().filter(|worth| !worth.on_explained) else { return };
        let is_of_a_rotor = |named: &&Named| signature_of(named.id).is_some_and(|of| of.role.which.is_some());
        let refuted = self.explanation.named.iter().filter(is_of_a_rotor).find_map(|named| {
            let better_percent = worth.better_without_percent(named.id)?;
            let chance = worth.chance_of_better_without(named.id)?;
            (better_percent > LEAST_BETTER_PERCENT && chance <= BY_CHANCE).then_some((named, better_percent))
        });
        let Some((named, better_percent)) = refuted else { return };
        let [explained, held] =
            traces().map(|traces| by_part(&traces, &self.explanation).unwrap_or_default());
        let [explained, held] =
            [&explained, &held].map(|parts| parts.iter().find(|part| part.id == named.id));
        let Some((explained, held)) = explained.zip(held) else { return };
        let shows =
            (explained.whole.0 - explained.nothing).abs() >= LEAST && explained.is_in_each_by(BEYOND_DOUBT);
        if !(shows && held.parts.iter().all(|part| explained.lacks(part, APART))) {
            return;
        }
        let name = brief(named, &self.given.vehicle, true);
        let reason = format!(
            "the hold-out flew without {name}: each part of the flights explained shows it by itself, and none of the hold-out does; without it \
             errors over 0.5 s on the hold-out are {} % smaller in the mean. A propeller or a motor was changed in between, or a load was placed \
             otherwise, so no name is tested on the hold-out",
            significant(better_percent, 2)
        );
        self.take_rotor_apart(OtherVehicle { by: Difference::Rotor { name }, reason });
    }

    /// The same, where another model of the same flights told it.
    pub(super) fn take_rotor_apart(&mut self, other: OtherVehicle) {
        if let Some(shown) = &mut self.shown {
            self.notes.push(Note::warning(About::HoldOut, other.reason.as_str()));
            shown.other_vehicle = Some(other);
        }
    }
}
