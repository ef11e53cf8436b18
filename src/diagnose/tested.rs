//! What a search tried, took and ended with.

use super::candidates::Candidate;
use super::evidence::Evidence;
use super::fit::Fitted;
use super::latency::LatencyFinding;

/// A candidate with its evidence.
#[derive(Debug, Clone)]
pub struct Tested {
    /// which
    pub candidate: Candidate,
    /// its coefficients in order of the parts' free parameters
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
    /// what was taken
    pub taken: Tested,
    /// others that would have passed, with their evidence
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

/// Where the search ended.
#[derive(Debug, Clone)]
pub struct Search {
    /// rigid body alone, with its latency
    pub before: Fitted,
    /// with all that was accepted
    pub after: Fitted,
    /// between command and rotor
    pub latency: LatencyFinding,
    /// in the order in which they were taken
    pub steps: Vec<Step>,
    /// every candidate about the final base
    pub last: Vec<Tested>,
}
