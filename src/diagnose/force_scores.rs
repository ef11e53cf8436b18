//! Score tests of forces that the model does not have, about the flight path reconstruction with those that it has.

use super::base::Base;
use super::fit::Fitted;
use super::reconstructed::{known_lag, terms};
use super::signature::EffectTerm;
use crate::reconstruction::{Scores, Term, fit_mode, force_problem};
use crate::signals::Signals;
use crate::stats::normal_deviate;

/// A force that was tested.
#[derive(Debug)]
pub(super) struct ForceScore {
    /// which, in the form that was tested
    pub term: EffectTerm,
    /// normal deviate, the lesser of that by the model and that by blocks of time
    pub z: f64,
    /// share of the reconstruction's misfit that it takes
    pub share: f64,
    /// root mean square of the force that it makes, as a share of the weight
    pub force: f64,
    /// size, in the order of the term's free slots
    pub step: Vec<f64>,
}

/// Tests each candidate whose force can be told from the motion. Empty where a flight cannot be reconstructed.
pub(super) fn force_scores(
    flights: &[Signals],
    fitted: &Fitted,
    latency_std_s: f64,
    candidates: &[EffectTerm],
) -> Vec<ForceScore> {
    let Some(own) = terms(&fitted.base) else { return Vec::new() };
    let weight_m_s2 = fitted.weight_n() / fitted.base.vehicle.body.mass_kg;
    let mut all = Vec::new();
    for signals in flights {
        let lag = known_lag(fitted, signals, latency_std_s);
        let problem = |extra: Vec<Term>| {
            let terms = own.iter().cloned().chain(extra).collect();
            force_problem(signals, &fitted.base.vehicle, lag, terms)
        };
        let Ok(base) = problem(Vec::new()) else { return Vec::new() };
        let free: Vec<usize> = (0..base.unknowns.len()).collect();
        let Ok(fit) = fit_mode(base, &free) else { return Vec::new() };
        for term in candidates {
            let alone = Base { present: vec![term.clone()], ..fitted.base.clone() };
            let Some(extra) = terms(&alone).and_then(|mut all| all.pop()) else { continue };
            let count = extra.free.len();
            if count == 0 {
                continue;
            }
            let Ok(problem) = problem(vec![extra]) else { continue };
            let Ok(scores) = Scores::about(&fit, problem) else { continue };
            let held: Vec<usize> = (free.len()..free.len() + count).collect();
            let Some(score) = scores.of(&held) else { continue };
            all.push(ForceScore {
                term: term.clone(),
                z: normal_deviate(score.chi_squared(), count),
                share: score.share(),
                force: score.force_m_s2 / weight_m_s2,
                step: score.step.iter().copied().collect(),
            });
        }
    }
    all
}
