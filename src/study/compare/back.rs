//! Whether the vehicle went back: flights after a step that are as flights before it.

use super::judge::Judge;
use super::result::{Change, Changed, Compared};
use super::scale::ScaleMoved;
use crate::change::Groups;

/// Share of a step of which less is left where the vehicle went back: it is nearer to what it was before than to what it was in between.
const LEFT: f64 = 0.5;
/// Standard errors by which less is left. The usual two.
const CERTAIN: f64 = 2.0;

impl Judge<'_> {
    /// Whether the later flights are as the earlier ones again after a step: nothing changed between them, and less than half of what the step
    /// changed is left, by two standard errors. Those of the balance contain a load that sits elsewhere, as where the step is judged: without it
    /// a battery that was put back elsewhere would decide.
    pub(super) fn is_back(&self, groups: &Groups, step: &Compared) -> bool {
        let compared = self.compared(groups);
        let is_gone = |change: &Change| {
            let left = self.left(change, step, (groups, &compared));
            left.is_some_and(|(share, std)| share.abs() + CERTAIN * std < LEFT)
        };
        compared.changes.is_empty() && step.certain().all(is_gone)
    }

    /// What is left of a change of a step between two groups, as a share of it, with its standard error. `None`: these do not determine it.
    fn left(
        &self,
        change: &Change,
        step: &Compared,
        (groups, compared): (&Groups, &Compared),
    ) -> Option<(f64, f64)> {
        let Changed::Parameter(place) = change.what else {
            return Some(step.balance.left_in(&compared.balance));
        };
        let scale = ScaleMoved::between(self.balance, groups);
        let (by, std) = self.judged(self.tracks.get(place)?, groups, scale)?.moved.by;
        let (size, _) = change.moved?.by;
        Some((by / size, std / size.abs()))
    }
}
