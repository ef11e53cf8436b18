//! Search over many random starts in rounds, each on a finer grid of instants.
//!
//! The descent of a start is deterministic, the random numbers depend only on the seed and the start's number, and the
//! selection orders by value and then by number. The result therefore depends only on the seed.

use super::descent::{BoundGrid, Iterate, Problem};
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// A round: every survivor descends on one grid, then the best stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round {
    /// instants a period at which the bounds are checked
    pub instants: u32,
    /// largest number of steps
    pub steps: u32,
    /// number of starts that enter the next round
    pub survivors: usize,
}

/// Settings of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// seed of the random starts
    pub seed: u64,
    /// number of random starts
    pub starts: u64,
    /// rounds before the last
    pub rounds: Vec<Round>,
    /// steps of the last round, on the final grid of instants
    pub final_steps: u32,
    /// every bound is kept with at least this share of its scale to spare
    pub margin: f64,
}

/// Least decrease of the criterion's logarithm for a step. A smaller one would spend minutes on the sixth digit.
const TOLERANCE: f64 = 1e-6;

impl Search {
    /// Rounds that suit five to ten harmonics.
    #[must_use]
    pub fn new(seed: u64, starts: u64) -> Self {
        let rounds = vec![
            Round { instants: 100, steps: 12, survivors: 8 },
            Round { instants: 100, steps: 40, survivors: 4 },
            Round { instants: 400, steps: 40, survivors: 2 },
        ];
        Self { seed, starts, rounds, final_steps: 40, margin: 1e-7 }
    }

    /// Number of descents of the search, for a progress bar.
    #[must_use]
    pub fn work(&self) -> u64 {
        let survivors = self.rounds.iter().map(|round| round.survivors as u64);
        self.starts + survivors.map(|count| count.min(self.starts)).sum::<u64>()
    }

    /// The best series, or `None` if no start could be evaluated. The last round has `final_instants` a period; `done`
    /// is called once a descent.
    #[must_use]
    pub fn run(&self, problem: &Problem, final_instants: u32, done: &(dyn Fn() + Sync)) -> Option<Iterate> {
        let mut points: Vec<DVector<f64>> = (0..self.starts).map(|start| self.draw(problem, start)).collect();
        for round in &self.rounds {
            let grid = BoundGrid::new(&problem.space, round.instants, self.margin);
            points = descend_all(problem, &grid, points, (round.steps, done))
                .into_iter()
                .take(round.survivors)
                .map(|iterate| iterate.unknowns)
                .collect();
        }
        let grid = BoundGrid::new(&problem.space, final_instants, self.margin);
        descend_all(problem, &grid, points, (self.final_steps, done)).into_iter().next()
    }

    /// The last round again from one point.
    #[must_use]
    pub fn polish(&self, problem: &Problem, point: DVector<f64>, instants: u32) -> Iterate {
        let grid = BoundGrid::new(&problem.space, instants, self.margin);
        let mut iterate = problem.iterate(point, &grid);
        problem.descend(&mut iterate, &grid, self.final_steps, TOLERANCE);
        iterate
    }

    /// Velocity coefficients of unit size.
    fn draw(&self, problem: &Problem, start: u64) -> DVector<f64> {
        let mut random =
            Pcg64Mcg::seed_from_u64(self.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(start));
        DVector::from_fn(problem.space.dimension(), |_, _| random.random_range(-0.3..0.3))
    }
}

/// All points after their descents, the best first.
fn descend_all(
    problem: &Problem,
    grid: &BoundGrid,
    points: Vec<DVector<f64>>,
    (steps, done): (u32, &(dyn Fn() + Sync)),
) -> Vec<Iterate> {
    let mut reached: Vec<Iterate> = points
        .into_par_iter()
        .map(|point| {
            let mut iterate = problem.iterate(point, grid);
            problem.descend(&mut iterate, grid, steps, TOLERANCE);
            done();
            iterate
        })
        .collect();
    // stable: equal merits keep the order of the starts
    reached.sort_by(|a, b| {
        let outside = |iterate: &Iterate| iterate.violation > grid.tightening();
        outside(a).cmp(&outside(b)).then(a.merit().total_cmp(&b.merit()))
    });
    reached
}
