//! One flight that is too short for a part to be held back: its names have no other data to stand on.

use super::refuted::Unshown;
use super::result::ExplainStudy;
use crate::diagnose::{Named, Trace, brief, by_part};

/// Least share by which errors over 0.5 s have to be smaller with an effect, mean over the quantities, %. On the data that an effect
/// was fitted to they are smaller even where it is worth nothing. Set by judgement.
const LEAST_WORTH_PERCENT: f64 = 5.0;

/// Why no name of a flight is certain.
#[derive(Debug, Clone, PartialEq)]
pub struct Short {
    /// s of flight that can be used
    pub usable_s: f64,
    /// names that were taken back, because the flight shows them too little: each in brief, with its size
    pub unsure: Vec<String>,
}

impl Short {
    /// A clause.
    pub(super) fn doubt(&self) -> String {
        format!(
            "the flight is short ({:.1} s can be used), so no part of it is left to test this on and no name is certain; fly longer, or give \
             another flight with --holdout",
            self.usable_s
        )
    }
}

impl ExplainStudy {
    /// The named effect of a short flight that is shown least: one that a half of the flight does not show by itself, or with which
    /// the flight itself is hardly predicted better. `None` where each name is shown, and where the flight is not short.
    pub(super) fn unshown(&self, traces: &[Trace]) -> Option<Unshown> {
        self.short.as_ref()?;
        let parts = by_part(traces, &self.explanation).unwrap_or_default();
        let in_halves = |id: &str| {
            let mut of = parts.iter().filter(|part| part.id == id);
            of.all(|part| part.is_in_each() && part.are_alike())
        };
        let worth_percent = |named: &Named| -> f64 {
            let worth = self.worth.as_ref();
            worth.and_then(|worth| worth.better_without_percent(named.id)).map_or(0.0, |better| -better)
        };
        let of = |named: &Named| {
            let worth_percent = worth_percent(named);
            let halves = in_halves(named.id);
            let unshown = !halves || worth_percent < LEAST_WORTH_PERCENT;
            let name = brief(named, &self.given.vehicle, true);
            unshown.then_some(Unshown { id: named.id, name, halves, worth_percent })
        };
        let refused = &self.given.settings.refused;
        let left = self.explanation.named.iter().filter(|named| !refused.contains(&named.id));
        let unshown = left.filter_map(of);
        unshown.min_by(|a, b| a.worth_percent.total_cmp(&b.worth_percent))
    }
}
