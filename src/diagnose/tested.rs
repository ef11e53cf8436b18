//! Candidates, steps and result of a search.

use super::candidates::Candidate;
use super::evidence::Evidence;
use super::fit::Fitted;
use super::latency::LatencyFinding;
use crate::reconstruction::Path;

/// A candidate with its evidence.
#[derive(Debug, Clone)]
pub struct Tested {
    /// which
    pub candidate: Candidate,
    /// its coefficients in the order of the parts' free parameters
    pub evidence: Evidence,
}

impl Tested {
    /// Emits it as a tracing event.
    pub(super) fn emit(&self) {
        let (effect, size) = (self.candidate.id, self.evidence.size());
        let Evidence { z, gain, energy, p_cluster, .. } = self.evidence;
        tracing::trace!(effect, z, size, gain, energy, p_cluster, "candidate tested");
    }
}

/// One accepted step.
#[derive(Debug, Clone)]
pub struct Step {
    /// the accepted candidate
    pub taken: Tested,
    /// other candidates that would have passed
    pub rivals: Vec<Tested>,
}

impl Step {
    /// Emits it as a tracing event.
    pub(super) fn emit(&self) {
        let (effect, size) = (self.taken.candidate.id, self.taken.evidence.size());
        let Evidence { z, gain, energy, .. } = self.taken.evidence;
        let rivals = self.rivals.len();
        tracing::info!(effect, z, size, gain, energy, rivals, "effect taken into the model");
    }
}

/// Result of a search.
#[derive(Debug, Clone)]
pub struct Search {
    /// rigid body alone, with its latency
    pub before: Fitted,
    /// with all accepted effects
    pub after: Fitted,
    /// latency between command and rotor
    pub latency: LatencyFinding,
    /// in the order in which they were taken
    pub steps: Vec<Step>,
    /// every candidate at the final base
    pub last: Vec<Tested>,
    /// Ixx, Iyy, Izz of the rigid body alone by a window of twice the width, as shares of those by the usual one; NaN before the model is
    /// refined, and where either has none
    pub by_wider_window: [f64; 3],
    /// variance that a law of the drag that the model does not have may bring into each free value of its effects; none before the model is
    /// refined
    pub(super) by_other_law: Vec<f64>,
    /// effects that stood in the place of others, and left: only the torques show them
    pub(super) misplaced: Vec<&'static str>,
    /// of each flight, once its forces were estimated with it
    pub(super) paths: Vec<Path>,
    /// the reconstructed flight path told which laws the drag follows, and their sizes
    pub(super) laws_by_path: bool,
}

impl Search {
    /// Whether forces were estimated along the reconstructed flight path, and not with the autopilot's velocity.
    #[must_use]
    pub fn is_by_path(&self) -> bool {
        !self.paths.is_empty()
    }

    /// Of a model that was not searched for.
    pub(super) fn of(after: Fitted, latency: LatencyFinding) -> Self {
        Self {
            before: after.clone(),
            after,
            latency,
            steps: Vec::new(),
            last: Vec::new(),
            by_wider_window: [f64::NAN; 3],
            by_other_law: Vec::new(),
            misplaced: Vec::new(),
            paths: Vec::new(),
            laws_by_path: false,
        }
    }
}
