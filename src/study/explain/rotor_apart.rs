//! A rotor that differs in the flights explained alone: between them and the hold-out a propeller or a motor was changed.

use super::hold_out::BY_CHANCE;
use super::result::ExplainStudy;
use super::validation_data::ValidationData;
use crate::diagnose::holdout::{Difference, OtherVehicle};
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{ByPart, Named, Trace, brief, by_part};
use crate::note::{About, Note};
use crate::text::significant;

/// Standard errors from none by which each part of the flights has to show the difference: far beyond what noise or a battery that was put
/// back elsewhere does. Set by judgement.
const BEYOND_DOUBT: f64 = 8.0;

impl ExplainStudy {
    /// Whether that is why the hold-out is one of another vehicle.
    pub(super) fn is_rotor_apart(&self) -> bool {
        let other = self.shown.as_ref().and_then(|shown| shown.other_vehicle.as_ref());
        other.is_some_and(|other| matches!(other.by, Difference::Rotor { .. }))
    }

    /// Takes a hold-out for one of another vehicle where it is predicted better without a rotor's difference that each part of the flights
    /// explained (`traces`) shows beyond doubt. A model without the name would have the difference in its mass and inertia.
    pub(super) fn tell_rotor_apart(&mut self, traces: impl FnOnce() -> Vec<Trace>) {
        if !matches!(self.shown_on, ValidationData::Flights(_)) || self.other_vehicle().is_some() {
            return;
        }
        let Some(worth) = self.worth.as_ref().filter(|worth| !worth.on_explained) else { return };
        let is_of_a_rotor = |named: &&Named| signature_of(named.id).is_some_and(|of| of.role.which.is_some());
        let refuted = self.explanation.named.iter().filter(is_of_a_rotor).find_map(|named| {
            let better_percent = worth.better_without_percent(named.id).filter(|percent| *percent > 0.0)?;
            let chance = worth.chance_of_better_without(named.id)?;
            (chance <= BY_CHANCE).then_some((named, better_percent))
        });
        let Some((named, better_percent)) = refuted else { return };
        let parts = by_part(&traces(), &self.explanation).unwrap_or_default();
        let of: Vec<&ByPart> = parts.iter().filter(|part| part.id == named.id).collect();
        if of.is_empty() || !of.iter().all(|part| part.is_in_each_by(BEYOND_DOUBT)) {
            return;
        }
        let name = brief(named, &self.given.vehicle, true);
        let reason = format!(
            "the hold-out flew without {name}: each part of the flights explained shows it by itself, and without it errors over 0.5 s on \
             the hold-out are {} % smaller in the mean; a propeller or a motor was changed in between",
            significant(better_percent, 2)
        );
        if let Some(shown) = &mut self.shown {
            self.notes.push(Note::warning(About::HoldOut, reason.as_str()));
            shown.other_vehicle = Some(OtherVehicle { by: Difference::Rotor { name }, reason });
        }
    }
}
