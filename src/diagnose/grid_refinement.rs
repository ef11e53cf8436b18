//! Refinement of candidates' values between the points of a grid: the time of a mass change, the length of a cord.

use super::candidates::Candidate;
use super::channels::Channels;
use super::evidence::Evidence;
use super::fit::Fitted;
use super::gates::possible;
use super::score::{at_once, columns_of_each};
use super::signature::GridScale;
use super::tested::Tested;
use super::trace::Trace;
use crate::vehicle::VehicleSize;
use rayon::prelude::*;

/// Refines the most likely cord length of the grid. A load that swings freely is out of phase with its neighbours on
/// the grid, and these explain too little of it to be accepted.
pub(super) fn between_grid(flights: &[Trace], fitted: &Fitted, tested: &[Tested]) -> Option<Tested> {
    let before = |tested: &&Tested| {
        tested.candidate.signature().is_some_and(|signature| signature.refinement.grid_before_test)
    };
    let loads = tested.iter().filter(before);
    let most = loads.max_by(|a, b| a.evidence.energy.total_cmp(&b.evidence.energy))?;
    (most.evidence.gain > WORTH_REFINING).then(|| refined(flights, fitted, most.clone()))
}

/// Share of the residual that a cord length of the grid has to explain. Only time depends on it: what explains less
/// has no chance of a name.
const WORTH_REFINING: f64 = 0.01;

/// Standard errors from which on an amount has a sign. The usual three.
const OF_A_SIGN: f64 = 3.0;

/// Neighbours on either side that are tried first: for cords they reach beyond the next length of the grid. A number
/// of steps: only the time of a search and its last digits depend on it.
const NEIGHBOURS: i32 = 10;

/// The candidate with the value, near its present one, that explains most energy. One with a possible amount is better than any
/// without: near its resonance a load of a wrong cord length swings against the true one, and would have a negative mass.
pub(super) fn refined(flights: &[Trace], fitted: &Fitted, tested: Tested) -> Tested {
    let scale = tested.candidate.signature().and_then(|signature| signature.refinement.grid);
    let Some(scale) = scale else { return tested };
    let each = |from: &Tested, by: &[f64]| -> Vec<Option<Tested>> {
        let moved = |by: &f64| moved(&from.candidate, scale, *by, &fitted.base.size);
        let candidates: Vec<Candidate> = by.iter().map(moved).collect();
        let columns = columns_of_each(flights, fitted, &candidates.iter().collect::<Vec<_>>());
        let tested = |(candidate, columns): (Candidate, Option<Vec<Channels>>)| {
            Some(Tested { candidate, evidence: fitted.weighted.test(&columns?)? })
        };
        candidates.into_iter().zip(columns).map(tested).collect()
    };
    let worth = |tested: &Tested| {
        let Evidence { z, energy, .. } = tested.evidence;
        (z.abs() > OF_A_SIGN && possible(tested, &fitted.base.size), energy)
    };
    let better = |a: Tested, b: Option<Tested>| match b {
        Some(b) if worth(&b) > worth(&a) => b,
        _ => a,
    };
    let (mut step, least) = match scale {
        GridScale::Even { step, least, .. } | GridScale::Relative { step, least, .. } => (step, least),
    };
    let steps: Vec<f64> = (-NEIGHBOURS..=NEIGHBOURS).map(|k| f64::from(k) * step).collect();
    let some = steps.len().min(at_once(fitted));
    let around: Vec<Option<Tested>> =
        steps.par_chunks(some).flat_map_iter(|steps| each(&tested, steps)).collect();
    let mut best = around.into_iter().fold(tested.clone(), better);
    while step > least {
        step *= 0.5;
        best = each(&best, &[step, -step]).into_iter().fold(best, better);
    }
    best
}

fn moved(candidate: &Candidate, scale: GridScale, by: f64, size: &VehicleSize) -> Candidate {
    let mut candidate = candidate.clone();
    for part in &mut candidate.parts {
        match scale {
            GridScale::Even { slot, .. } => {
                part.values[slot] = part.possible(slot, part.values[slot] + by, size);
            }
            GridScale::Relative { slot, .. } => {
                part.values[slot] = part.possible(slot, part.values[slot] * by.exp(), size);
            }
        }
    }
    candidate
}
