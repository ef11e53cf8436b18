//! Values that candidates have on a grid, brought between the grid's points: when a mass changed, how long a
//! cord is.

use super::candidates::Candidate;
use super::fit::Fitted;
use super::tested::Tested;
use super::trace::Trace;
use super::trial::columns_of;
use rayon::prelude::*;

/// The slot that lies on a grid, its first step and where refining ends.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// steps in the value's unit
    Even { slot: usize, step: f64, least: f64 },
    /// steps as shares of the value
    Relative { slot: usize, step: f64, least: f64 },
}

fn scale_of(id: &str) -> Option<Scale> {
    match id {
        // s
        "mass_change" => Some(Scale::Even { slot: 0, step: 0.5, least: 0.03 }),
        // m
        "ceiling_effect" => Some(Scale::Even { slot: 2, step: 0.03, least: 0.003 }),
        // of the length
        "slung_load" => Some(Scale::Relative { slot: 1, step: 0.04, least: 0.002 }),
        _ => None,
    }
}

/// The likeliest cord brought between the grid's lengths: a load that swings freely is out of step with its
/// neighbours on the grid, and they explain too little of it to be taken.
pub(super) fn between_grid(flights: &[Trace], fitted: &Fitted, tested: &[Tested]) -> Option<Tested> {
    let loads = tested.iter().filter(|tested| tested.candidate.id == "slung_load");
    let most = loads.max_by(|a, b| a.evidence.energy.total_cmp(&b.evidence.energy))?;
    (most.evidence.gain > WORTH_SHARPENING).then(|| sharpened(flights, fitted, most.clone()))
}

/// Share of the residual that a cord of the grid has to explain.
const WORTH_SHARPENING: f64 = 0.01;

/// Neighbours on either side that are tried first.
const NEIGHBOURS: i32 = 6;

/// The candidate with the value that explains most energy, near the one it has.
pub(super) fn sharpened(flights: &[Trace], fitted: &Fitted, tested: Tested) -> Tested {
    let Some(scale) = scale_of(tested.candidate.id) else { return tested };
    let at = |from: &Tested, by: f64| {
        let candidate = moved(&from.candidate, scale, by);
        let columns = columns_of(flights, fitted, &candidate)?;
        let evidence = fitted.weighted.test(&columns)?;
        Some(Tested { candidate, evidence })
    };
    let better = |a: Tested, b: Option<Tested>| match b {
        Some(b) if b.evidence.energy > a.evidence.energy => b,
        _ => a,
    };
    let (mut step, least) = match scale {
        Scale::Even { step, least, .. } | Scale::Relative { step, least, .. } => (step, least),
    };
    let around: Vec<Option<Tested>> =
        (-NEIGHBOURS..=NEIGHBOURS).into_par_iter().map(|k| at(&tested, f64::from(k) * step)).collect();
    let mut best = around.into_iter().fold(tested.clone(), better);
    while step > least {
        step *= 0.5;
        let sides = rayon::join(|| at(&best, step), || at(&best, -step));
        best = [sides.0, sides.1].into_iter().fold(best, better);
    }
    best
}

fn moved(candidate: &Candidate, scale: Scale, by: f64) -> Candidate {
    let mut candidate = candidate.clone();
    for part in &mut candidate.parts {
        match scale {
            Scale::Even { slot, .. } => part.values[slot] = part.possible(slot, part.values[slot] + by),
            Scale::Relative { slot, .. } => {
                part.values[slot] = part.possible(slot, part.values[slot] * by.exp());
            }
        }
    }
    candidate
}
