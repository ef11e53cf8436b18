//! An empirical force that flights which were not used refute.

use crate::diagnose::Along;
use crate::note::{About, Note};
use crate::text::significant;

/// Mean over the quantities by which errors over 0.5 s are larger with an empirical force from which on it is left out, %. Predictions are
/// repeated to a tenth of this.
pub(super) const WORSE_PERCENT: f64 = 1.0;

/// An empirical force that was left out, because flights that were not used are predicted worse with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOutForce {
    /// the quantity on which it depends
    pub along: Along,
    /// by how much errors over 0.5 s are larger with it, mean over the quantities, %
    pub worse_percent: f64,
}

impl LeftOutForce {
    pub(super) fn note(&self) -> Note {
        let text = format!(
            "an empirical force along {} fits the flights explained; with it, errors over 0.5 s are {} % larger in the mean on what was not \
             used, so it is left out",
            self.along.name(),
            significant(self.worse_percent, 2)
        );
        Note::warning(About::HoldOut, text)
    }
}
