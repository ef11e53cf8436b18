//! Local descent from one start: sequential convex programmes with a proximal term.
//!
//! `W^T W` is (but for the small nonlinearity of the attitude) convex in the coefficients, so its
//! smallest eigenvalue, linearised, is bounded from below by the linearisation, and the optimum lies at
//! a corner of the bounds. Steps to the corners of the linearised problem need no curvature model; a
//! proximal weight keeps the few directions that the corner leaves free under control.

use super::bounds::{Bound, Dynamics, Instant};
use super::criterion::Criterion;
use super::information::GramSampler;
use super::quadratic::{QuadraticOutcome, QuadraticProgram};
use super::space::{PathRows, SeriesSpace};
use nalgebra::{DVector, SVector};

/// Rows whose bound is further away than this share of its scale are left out of a step.
const REACH: f64 = 0.5;
/// Price of the largest relative violation, against the logarithm of the criterion.
const VIOLATION_PRICE: f64 = 20.0;
/// Curvature that makes the auxiliary unknowns of a step strictly convex; their slopes are of order one.
const AUXILIARY_CURVATURE: f64 = 1e-3;
/// Rows of a step are kept to this share of the bound's scale.
const ROW_TOLERANCE: f64 = 1e-11;

/// What is to be minimised over which series inside which bounds.
#[derive(Debug, Clone)]
pub struct Problem {
    /// series that start and end at rest
    pub space: SeriesSpace,
    /// the information of a period
    pub sampler: GramSampler,
    /// what is minimised
    pub criterion: Criterion,
    /// size against which each parameter's error is measured
    pub parameter_scale: SVector<f64, 7>,
    /// what must hold
    pub bounds: Vec<Bound>,
    /// wrench of the nominal body
    pub dynamics: Dynamics,
}

/// Instants at which the bounds are held during a descent.
#[derive(Debug, Clone)]
pub struct BoundGrid {
    instants: Vec<PathRows>,
    /// every bound is tightened by this share of its scale
    tightening: f64,
}

/// A point of the descent.
#[derive(Debug, Clone)]
pub struct Iterate {
    /// free coefficients
    pub unknowns: DVector<f64>,
    /// logarithm of the criterion
    pub log_value: f64,
    /// largest relative violation on the grid; negative: a margin
    pub violation: f64,
    /// proximal weight of the next step
    pub proximal: f64,
    /// the last step promised less than the tolerance
    pub settled: bool,
}

/// One linearised bound: `excess + gradient d <= 0`.
struct BoundRow {
    excess: f64,
    gradient: Vec<f64>,
}

impl BoundGrid {
    /// `count` equal steps over a period.
    #[must_use]
    pub fn new(space: &SeriesSpace, count: u32, tightening: f64) -> Self {
        let step_s = space.period_s() / f64::from(count.max(1));
        let instants = (0..count).map(|k| space.rows(f64::from(k) * step_s)).collect();
        Self { instants, tightening }
    }
}

impl Problem {
    /// Evaluates a start.
    #[must_use]
    pub fn iterate(&self, unknowns: DVector<f64>, grid: &BoundGrid) -> Iterate {
        let log_value = self.log_value(&unknowns);
        let violation = self.violation(&unknowns, grid);
        Iterate { unknowns, log_value, violation, proximal: 1.0, settled: false }
    }

    fn log_value(&self, unknowns: &DVector<f64>) -> f64 {
        self.criterion.log_value(&self.sampler.matrix(unknowns), &self.parameter_scale)
    }

    /// Largest violation of any bound on the grid, relative to the bound's scale.
    #[must_use]
    pub fn violation(&self, unknowns: &DVector<f64>, grid: &BoundGrid) -> f64 {
        let mut worst = f64::NEG_INFINITY;
        for rows in &grid.instants {
            let instant = Instant::new(rows.path(unknowns), &self.dynamics);
            for bound in &self.bounds {
                let value = instant.value(bound.quantity, &self.dynamics);
                for (excess, _) in excesses(bound, value) {
                    worst = worst.max(excess + grid.tightening);
                }
            }
        }
        if worst.is_nan() { f64::INFINITY } else { worst }
    }

    fn bound_rows(&self, unknowns: &DVector<f64>, grid: &BoundGrid) -> Vec<BoundRow> {
        let mut out = Vec::new();
        for rows in &grid.instants {
            let instant = Instant::new(rows.path(unknowns), &self.dynamics);
            for bound in &self.bounds {
                let value = instant.value(bound.quantity, &self.dynamics);
                for (excess, sign) in excesses(bound, value) {
                    if excess + grid.tightening < -REACH {
                        continue;
                    }
                    let mut gradient = vec![0.0; unknowns.len()];
                    let slope = instant.slope(bound.quantity, &self.dynamics);
                    let share = sign / bound.scale();
                    rows.pull_back(&slope.map(|axis| axis.map(|entry| entry * share)), &mut gradient);
                    if gradient.iter().any(|value| value.abs() > 1e-9) {
                        out.push(BoundRow { excess: excess + grid.tightening, gradient });
                    }
                }
            }
        }
        out
    }

    /// Takes up to `steps` steps; stops where a step promises less than `tolerance` of the logarithm.
    pub fn descend(&self, iterate: &mut Iterate, grid: &BoundGrid, steps: u32, tolerance: f64) {
        for _ in 0..steps {
            if iterate.settled || !self.step(iterate, grid, tolerance) {
                return;
            }
        }
    }

    /// One accepted step. False where none is found.
    fn step(&self, iterate: &mut Iterate, grid: &BoundGrid, tolerance: f64) -> bool {
        let gram = self.sampler.sloped(&iterate.unknowns);
        let Some(pieces) = self.criterion.pieces(&gram, &self.parameter_scale) else {
            return false;
        };
        let width = iterate.unknowns.len();
        let groups = pieces.len();
        let rows = self.bound_rows(&iterate.unknowns, grid);
        let mut program = QuadraticProgram {
            slope: [vec![0.0; width], vec![1.0; groups], vec![VIOLATION_PRICE]].concat(),
            ..QuadraticProgram::default()
        };
        for (number, group) in pieces.iter().enumerate() {
            let largest = group.iter().map(|piece| piece.value).fold(f64::NEG_INFINITY, f64::max);
            for piece in group {
                let auxiliary = (0..=groups).map(|k| if k == number { -1.0 } else { 0.0 });
                program.push(piece.gradient.iter().copied().chain(auxiliary), largest - piece.value);
            }
        }
        for row in &rows {
            let relaxed = if row.excess > 0.0 { -1.0 } else { 0.0 };
            let auxiliary = (0..=groups).map(|k| if k == groups { relaxed } else { 0.0 });
            program.push(row.gradient.iter().copied().chain(auxiliary), -row.excess);
        }
        program.push((0..=width + groups).map(|k| if k == width + groups { -1.0 } else { 0.0 }), 0.0);

        for _ in 0..12 {
            program.curvature =
                [vec![iterate.proximal; width], vec![AUXILIARY_CURVATURE; groups + 1]].concat();
            let QuadraticOutcome::Solved(z) = program.solve(ROW_TOLERANCE) else {
                iterate.proximal *= 10.0;
                continue;
            };
            let gain: f64 = z.rows(width, groups).sum();
            let repair = z[width + groups] - iterate.violation.max(0.0);
            let promised = -(gain + VIOLATION_PRICE * repair);
            if promised < tolerance {
                iterate.settled = true;
                return false;
            }
            let unknowns = &iterate.unknowns + z.rows(0, width);
            let log_value = self.log_value(&unknowns);
            let violation = self.violation(&unknowns, grid);
            let change = iterate.log_value - log_value
                + VIOLATION_PRICE * (iterate.violation.max(0.0) - violation.max(0.0));
            let ratio = change / promised;
            if ratio > 0.1 {
                let factor = if ratio > 0.7 { 0.3 } else { 1.0 };
                let proximal = (iterate.proximal * factor).max(1e-6);
                *iterate = Iterate { unknowns, log_value, violation, proximal, settled: false };
                return true;
            }
            iterate.proximal *= 5.0;
        }
        iterate.settled = true;
        false
    }
}

/// Violation of each side relative to the scale, with the sign of its slope.
fn excesses(bound: &Bound, value: f64) -> impl Iterator<Item = (f64, f64)> {
    let scale = bound.scale();
    let above = bound.max.map(|max| ((value - max) / scale, 1.0));
    let below = bound.min.map(|min| ((min - value) / scale, -1.0));
    above.into_iter().chain(below)
}
