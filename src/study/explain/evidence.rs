//! What was tried, in the order in which it is told.

use crate::diagnose::Tested;

use super::ExplainStudy;

/// Rivals of a step that are told.
const RIVALS: usize = 4;
/// Candidates about the final model that are told, the strongest first.
const LAST: usize = 12;

/// When an effect was tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TriedAs {
    /// taken in this step, from 1
    Taken(usize),
    /// would have passed in that step
    Rival,
    /// about the final model: not named
    Left,
}

/// One effect that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// when, and how that ended
    pub tried_as: TriedAs,
    /// identifier of the effect
    pub id: &'static str,
    /// normal deviate of the evidence
    pub z: f64,
    /// share of the residual energy
    pub gain: f64,
    /// chance over blocks of the flight
    pub p_cluster: f64,
}

impl Tried {
    fn new(tried_as: TriedAs, tested: &Tested) -> Self {
        let of = &tested.evidence;
        Self { tried_as, id: tested.candidate.id, z: of.z, gain: of.gain, p_cluster: of.p_cluster }
    }
}

impl ExplainStudy {
    /// What was taken, step by step with its rivals, and what was tried about the final model.
    #[must_use]
    pub fn tried(&self) -> Vec<Tried> {
        let search = &self.explanation.search;
        let mut all = Vec::new();
        for (index, step) in search.steps.iter().enumerate() {
            all.push(Tried::new(TriedAs::Taken(index + 1), &step.taken));
            all.extend(step.rivals.iter().take(RIVALS).map(|rival| Tried::new(TriedAs::Rival, rival)));
        }
        let mut last: Vec<&Tested> = search.last.iter().collect();
        last.sort_by(|a, b| b.evidence.z.abs().total_cmp(&a.evidence.z.abs()));
        all.extend(last.into_iter().take(LAST).map(|tested| Tried::new(TriedAs::Left, tested)));
        all
    }
}
