//! Names that flights would give and that get none.

use super::result::ExplainStudy;
use crate::diagnose::brief;
use crate::diagnose::signatures::signature_of;
use crate::note::{About, Note};

/// Quantities that a force moves, in the order of those that are predicted: position and velocity.
const BY_FORCE: usize = 2;

/// A load that the flights would name, and with which their own motion is not predicted better.
#[derive(Debug, Clone, PartialEq)]
struct Idle {
    /// the effect
    id: &'static str,
    /// in brief, with its size
    name: String,
}

impl Idle {
    fn note(&self) -> Note {
        let text = format!(
            "the flights explained alone would give a name to {}; with it, neither their position nor their velocity over 0.5 s is predicted \
             better than by the rigid body, so it gets none",
            self.name
        );
        Note::warning(About::Estimate, text)
    }
}

impl ExplainStudy {
    /// An effect that the flights explained would name and that gets no name, and why: it does nothing for the motion of these flights, or that
    /// of others is predicted better without it. Its name in brief goes with it where other flights decide.
    pub(super) fn nameless(&self) -> Option<(&'static str, Option<String>, Note)> {
        let is_new = |id: &&str| !self.given.settings.refused.contains(id);
        let idle = self.idle().filter(|of| is_new(&of.id)).map(|of| (of.id, None, of.note()));
        let worthless = || self.worthless().filter(|of| is_new(&of.id));
        idle.or_else(|| worthless().map(|of| (of.id, Some(of.name.clone()), of.note())))
    }

    /// A load on a cord, which acts by a force alone, as the only name, where the model with it predicts neither position nor velocity of the very
    /// flights that it was fitted to better than the rigid body: it stands for something else, as for the noise of an estimator.
    fn idle(&self) -> Option<Idle> {
        let [named] = &self.explanation.named[..] else { return None };
        let hangs = signature_of(named.id).is_some_and(|of| of.role.hangs_below);
        let by_force = &self.identify.as_ref()?.half_second()[..BY_FORCE];
        let is_better = by_force.iter().flatten().any(|of| of.after.value < of.before.value);
        let is_told = by_force.iter().any(Option::is_some);
        (hangs && is_told && !is_better)
            .then(|| Idle { id: named.id, name: brief(named, &self.given.vehicle, true) })
    }
}
