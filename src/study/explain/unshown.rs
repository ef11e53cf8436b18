//! Names that a short flight does not show well enough.

use super::limited::FlightLimit;
use super::refuted::Unshown;
use super::result::ExplainStudy;
use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{ByPart, Named, Trace, brief, by_part, known_to};

/// Least share by which errors over 0.5 s have to be smaller with an effect, mean over the quantities, %. On the data that an effect
/// was fitted to they are smaller even where it is worth nothing. Set by judgement.
const LEAST_WORTH_PERCENT: f64 = 5.0;

impl ExplainStudy {
    /// The named effect of a short flight that is shown least. It is one that the halves of the flight do not both show by themselves and
    /// alike, one with which the flight itself is hardly predicted better, or a force of the air where the vehicle only hovers. `None` where
    /// each name is shown, and where the flight is not short. A lag or delay is told by how sharp its latency is, and what changes at one
    /// moment by the seconds about it.
    pub(super) fn unshown(&self, traces: &[Trace]) -> Option<Unshown> {
        self.short.as_ref()?;
        let parts = by_part(traces, &self.explanation).unwrap_or_default();
        tracing::debug!(?parts, "names of a short flight by its halves");
        let is_judged = |named: &&Named| {
            let refused = self.given.settings.refused.contains(&named.id);
            let lasts = |of: &Signature| of.role.latency.is_none() && of.role.moment.is_none();
            !refused && signature_of(named.id).is_some_and(lasts)
        };
        let judged = |named: &Named| {
            let of: Vec<&ByPart> = parts.iter().filter(|part| part.id == named.id).collect();
            let halves = !of.is_empty() && of.iter().all(|part| part.is_in_each() && part.are_alike());
            let better_without = self.worth.as_ref().and_then(|worth| worth.better_without_percent(named.id));
            // of one that predicts together with another one nothing is known
            let worth_percent = better_without.map_or(f64::INFINITY, |better| -better);
            let is_of_air = signature_of(named.id).is_some_and(|of| of.role.of_air || of.role.wind.is_some());
            let hovers = is_of_air && self.given.limited.contains(&FlightLimit::Hover);
            let unshown = hovers || !halves || worth_percent < LEAST_WORTH_PERCENT;
            let name = brief(named, &self.given.vehicle, true);
            unshown.then_some(Unshown { id: named.id, name, hovers, halves, worth_percent, beside: None })
        };
        let names = || self.explanation.named.iter().filter(is_judged);
        let least = names()
            .filter_map(|named| Some((named, judged(named)?)))
            .min_by(|(_, a), (_, b)| a.worth_percent.total_cmp(&b.worth_percent));
        let (named, unshown) = least?;
        // of two laws of the drag, which are nearly one force, the one that is known worse goes first
        let drags = |named: &&Named| signature_of(named.id).is_some_and(Signature::is_drag);
        let uncertainty = |named: &Named| known_to(named).unwrap_or(f64::INFINITY);
        let worst = names().filter(drags).max_by(|a, b| uncertainty(a).total_cmp(&uncertainty(b)));
        let other = worst.filter(|worst| drags(&named) && worst.id != named.id);
        Some(match other {
            Some(other) => Unshown {
                id: other.id,
                name: brief(other, &self.given.vehicle, true),
                beside: Some(named.id),
                ..unshown
            },
            None => unshown,
        })
    }
}
