//! From which distance on two effects are told apart.

use super::named::Confusable;
use super::signatures::latency_kind;

/// Effects whose distance is below this many standard deviations are not distinguished. Set by judgement: an effect
/// is named from four standard errors on, and one more is asked of a distinction; the pairs in the figures are by
/// this value (`cargo bench --bench explain -- --pairs 12 --seed 2026112501`).
pub(in crate::diagnose) const APART: f64 = 5.0;
/// The same for a lag and a delay. More than for other pairs, because rotors with different rising and falling time constants are
/// neither and resemble a delay. Set by judgement; measured only together with all conditions of a name (see `Gates`).
pub(in crate::diagnose) const LATENCY_APART: f64 = 15.0;

/// Standard deviations from which on an effect is distinguished from the effect `other`.
pub(in crate::diagnose) fn apart_from(other: &str) -> f64 {
    if latency_kind(other).is_some() { LATENCY_APART } else { APART }
}

impl Confusable {
    /// Whether the flight tells it from the named effect, although it explains nearly as much.
    #[must_use]
    pub fn is_told_apart(&self) -> bool {
        self.distinguishability.is_some_and(|distance| distance >= apart_from(self.id))
    }
}
