//! Whether an explanation is certain, and how well its sizes are known.

use super::result::ExplainStudy;
use crate::diagnose::{ByPart, Named, Verdict, by_part};
use crate::note::{About, Note};

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
            && self.unsettled().next().is_none()
    }

    /// Named effects that are not certain to be in each part of the flights.
    pub fn unsettled(&self) -> impl Iterator<Item = &ByPart> {
        self.by_part.iter().filter(|of| !of.is_certain())
    }

    /// Fits the named effects to each part of the flights.
    pub(super) fn tell_by_part(&mut self) {
        match by_part(&self.traces, &self.explanation) {
            Ok(found) => self.by_part = found,
            Err(error) => {
                let text = format!("whether each part of the flights shows the names: {error}");
                self.notes.push(Note::warning(About::Estimate, text));
            }
        }
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
