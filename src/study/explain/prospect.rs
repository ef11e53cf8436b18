//! Whether an explanation is certain, and how well its sizes are known.

use super::result::ExplainStudy;
use crate::diagnose::{Named, Verdict};

impl ExplainStudy {
    /// No further flight is needed: nothing is left over, and no name could be another one's.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        let decided = matches!(self.verdict(), Verdict::NothingMissing | Verdict::Explained);
        decided
            && !self.explanation.too_little_excitation
            && self.doubts().is_empty()
            && self.other_vehicle().is_none()
            && self.effects.iter().all(|effect| effect.confusable_with.is_empty())
    }

    /// Relative standard error (-) of the size of an effect: of its best known parameter with a unit. `None` where no
    /// parameter is such a size.
    #[must_use]
    pub fn known_to(&self, effect: &Named) -> Option<f64> {
        let sizes = effect.parameters.iter().filter(|parameter| parameter.unit != "-" && parameter.std > 0.0);
        let relative = sizes.map(|parameter| parameter.std / parameter.value.abs());
        relative.filter(|relative| relative.is_finite()).min_by(f64::total_cmp)
    }
}
