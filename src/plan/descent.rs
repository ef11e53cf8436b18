//! Local descent from one start: sequential convex programmes.
//!
//! The criterion is a convex function of `G = W^T D W` (for the two condition numbers: a maximum over
//! eigenvalues), `G` is close to a quadratic in the unknowns, and all bounds but those of attitude,
//! thrust and torque are linear. Each step therefore linearises `G` and the bounds, but keeps the
//! criterion as the convex function it is, by adding supports wherever the step lands (cutting planes).
//! So meeting eigenvalues do no harm, and the optimum, a corner of many bounds, is reached in few steps
//! without any estimate of curvature. A proximal term holds the few directions that no bound holds, and
//! a second-order correction takes out the curvature of the nonlinear bounds.

use super::bounds::{Bound, Dynamics, Instant};
use super::criterion::{Criterion, Support};
use super::information::{GramSampler, SlopedGram};
use super::quadratic::{QuadraticOutcome, QuadraticProgram};
use super::space::{PathRows, SeriesSpace};
use nalgebra::{DMatrix, DVector, SVector};

/// Rows whose bound is farther than this share of its scale are left out of a step: one that is reached is in the next.
const REACH: f64 = 0.5;
/// Price of the largest relative violation against the logarithm of the criterion. The multipliers of
/// the bounds add up to about one, because the criterion falls in proportion to the size of the motion.
const VIOLATION_PRICE: f64 = 2.0;
/// Curvature that makes the auxiliary unknowns of a step strictly convex; their slopes are of order one.
const AUXILIARY_CURVATURE: f64 = 1e-3;
/// Rows of a step are kept to this share of the bound's scale.
const ROW_TOLERANCE: f64 = 1e-11;
/// Rows that hardly depend on the unknowns, those next to a prescribed start, are left out, because they impair the
/// condition of a step. Their contribution is far below the tightening of the bounds.
const LEVER_MIN: f64 = 1e-6;
/// How often supports are added within a step.
const SUPPORT_ROUNDS: u32 = 12;

/// The minimisation problem: series, criterion and bounds.
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
    /// bounds
    pub bounds: Vec<Bound>,
    /// wrench of the nominal body
    pub dynamics: Dynamics,
}

/// Instants at which the bounds are checked during a descent.
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
    /// whether no step has an expected decrease above the tolerance
    pub settled: bool,
    /// proximal weight of the next step
    proximal: f64,
    /// `[bound][instant]`
    values: Vec<Vec<f64>>,
}

/// One linearised bound: `excess + gradient d <= 0`.
struct BoundRow {
    excess: f64,
    gradient: Vec<f64>,
    instant: usize,
    bound: usize,
    side: Side,
}

/// One side of a bound, with the sign that makes a violation positive.
#[derive(Debug, Clone, Copy)]
struct Side {
    limit: f64,
    sign: f64,
}

impl Side {
    fn of(bound: &Bound) -> impl Iterator<Item = Self> {
        let above = bound.max.map(|limit| Self { limit, sign: 1.0 });
        let below = bound.min.map(|limit| Self { limit, sign: -1.0 });
        above.into_iter().chain(below)
    }

    /// Relative violation; negative: a margin.
    fn excess(self, value: f64, bound: &Bound) -> f64 {
        self.sign * (value - self.limit) / bound.scale()
    }
}

impl BoundGrid {
    /// `count` equal steps over a period; every bound is tightened by a share of its scale.
    #[must_use]
    pub fn new(space: &SeriesSpace, count: u32, tightening: f64) -> Self {
        let step_s = space.period_s() / f64::from(count.max(1));
        let instants = (0..count).map(|k| space.rows(f64::from(k) * step_s)).collect();
        Self { instants, tightening }
    }

    /// The share of its scale by which every bound is tightened.
    #[must_use]
    pub fn tightening(&self) -> f64 {
        self.tightening
    }
}

impl Problem {
    /// Evaluates a start.
    #[must_use]
    pub fn iterate(&self, unknowns: DVector<f64>, grid: &BoundGrid) -> Iterate {
        let gram = self.sampler.matrix(&unknowns);
        let log_value = self.criterion.log_value(&gram, &self.parameter_scale);
        let values = self.values(&unknowns, grid);
        let violation = self.violation(&values, grid);
        Iterate { unknowns, log_value, violation, settled: false, proximal: 1.0, values }
    }

    /// Takes up to `steps` steps; stops at an expected decrease of the logarithm below `tolerance`.
    pub fn descend(&self, iterate: &mut Iterate, grid: &BoundGrid, steps: u32, tolerance: f64) {
        for _ in 0..steps {
            if iterate.settled {
                return;
            }
            self.step(iterate, grid, tolerance);
        }
    }

    fn values(&self, unknowns: &DVector<f64>, grid: &BoundGrid) -> Vec<Vec<f64>> {
        let mut values = vec![Vec::with_capacity(grid.instants.len()); self.bounds.len()];
        for rows in &grid.instants {
            let instant = Instant::new(rows.path(unknowns), &self.dynamics);
            for (bound, out) in self.bounds.iter().zip(&mut values) {
                out.push(instant.value(bound.quantity, &self.dynamics));
            }
        }
        values
    }

    /// Largest violation of any bound, relative to the bound's scale.
    fn violation(&self, values: &[Vec<f64>], grid: &BoundGrid) -> f64 {
        let mut worst = f64::NEG_INFINITY;
        for (bound, values) in self.bounds.iter().zip(values) {
            for side in Side::of(bound) {
                for value in values {
                    let excess = side.excess(*value, bound);
                    worst = if excess.is_nan() { f64::INFINITY } else { worst.max(excess) };
                }
            }
        }
        worst + grid.tightening
    }

    fn bound_rows(&self, iterate: &Iterate, grid: &BoundGrid) -> Vec<BoundRow> {
        let mut rows = Vec::new();
        for (index, (bound, values)) in self.bounds.iter().zip(&iterate.values).enumerate() {
            for side in Side::of(bound) {
                for instant in instants_that_matter(values, side.sign) {
                    let excess = side.excess(values[instant], bound) + grid.tightening;
                    if excess < -REACH {
                        continue;
                    }
                    let gradient = self.gradient(iterate, &grid.instants[instant], (bound, side));
                    if gradient.iter().any(|value| value.abs() > LEVER_MIN) {
                        rows.push(BoundRow { excess, gradient, instant, bound: index, side });
                    }
                }
            }
        }
        rows
    }

    fn gradient(&self, iterate: &Iterate, rows: &PathRows, (bound, side): (&Bound, Side)) -> Vec<f64> {
        let mut gradient = vec![0.0; iterate.unknowns.len()];
        let instant = Instant::new(rows.path(&iterate.unknowns), &self.dynamics);
        let slope = instant.slope(bound.quantity, &self.dynamics);
        let share = side.sign / bound.scale();
        rows.pull_back(&slope.map(|axis| axis.map(|entry| entry * share)), &mut gradient);
        gradient
    }

    /// One accepted step, or `settled`.
    fn step(&self, iterate: &mut Iterate, grid: &BoundGrid, tolerance: f64) {
        let gram = self.sampler.sloped(&iterate.unknowns);
        let Some(mut model) = StepModel::new(self, iterate, grid, gram) else {
            iterate.settled = true;
            return;
        };
        for _ in 0..12 {
            let Some(step) = model.solve(iterate.proximal) else {
                iterate.proximal *= 10.0;
                continue;
            };
            let promised = -step.gain + VIOLATION_PRICE * (iterate.violation.max(0.0) - step.violation);
            if promised < tolerance {
                break;
            }
            let mut next = self.iterate(&iterate.unknowns + &step.change, grid);
            if next.violation > iterate.violation.max(0.0) + 0.1 * promised {
                let corrected = model.solve_corrected(self, &next, &step, iterate.proximal);
                if let Some(corrected) = corrected {
                    let other = self.iterate(&iterate.unknowns + &corrected.change, grid);
                    if other.merit() < next.merit() {
                        next = other;
                    }
                }
            }
            let ratio = (iterate.merit() - next.merit()) / promised;
            if ratio > 0.1 {
                next.proximal = (iterate.proximal * if ratio > 0.7 { 0.3 } else { 1.0 }).max(1e-5);
                *iterate = next;
                return;
            }
            iterate.proximal *= 5.0;
        }
        iterate.settled = true;
    }
}

impl Iterate {
    /// The merit function that a step must decrease.
    #[must_use]
    pub fn merit(&self) -> f64 {
        self.log_value + VIOLATION_PRICE * self.violation.max(0.0)
    }
}

/// The convex model of one step.
struct StepModel {
    criterion: Criterion,
    parameter_scale: SVector<f64, 7>,
    gram: SlopedGram,
    /// value of each term of the criterion here
    terms: Vec<f64>,
    program: QuadraticProgram,
    rows: Vec<BoundRow>,
    tightening: f64,
    /// first row of the programme that belongs to a bound
    first_bound_row: usize,
}

/// The step of a step model.
struct Step {
    change: DVector<f64>,
    /// change of the modelled criterion
    gain: f64,
    /// largest relative violation of the linearised bounds
    violation: f64,
}

impl StepModel {
    fn new(problem: &Problem, iterate: &Iterate, grid: &BoundGrid, gram: SlopedGram) -> Option<Self> {
        let width = iterate.unknowns.len();
        let supports = problem.criterion.supports(&gram.matrix, &problem.parameter_scale)?;
        let mut terms = vec![f64::NEG_INFINITY; problem.criterion.terms()];
        for support in &supports {
            terms[support.term] = terms[support.term].max(support.value);
        }
        let slope = [vec![0.0; width], vec![1.0; terms.len()], vec![VIOLATION_PRICE]].concat();
        let mut model = Self {
            criterion: problem.criterion,
            parameter_scale: problem.parameter_scale,
            gram,
            terms,
            program: QuadraticProgram::new(DMatrix::zeros(0, 0), slope),
            rows: problem.bound_rows(iterate, grid),
            tightening: grid.tightening,
            first_bound_row: supports.len(),
        };
        let here = DVector::zeros(width);
        for support in &supports {
            let (row, limit) = model.support_row(support, &here);
            model.program.push(row, limit);
        }
        let terms = model.terms.len();
        for row in &model.rows {
            let relaxed = if row.excess > 0.0 { -1.0 } else { 0.0 };
            let auxiliary = (0..=terms).map(|k| if k == terms { relaxed } else { 0.0 });
            model.program.push(row.gradient.iter().copied().chain(auxiliary), -row.excess);
        }
        let last = width + terms;
        model.program.push((0..=last).map(|k| if k == last { -1.0 } else { 0.0 }), 0.0);
        Some(model)
    }

    /// `value + <slope, dG (d - at)> - s_term <= term's value here`
    fn support_row(&self, support: &Support, at: &DVector<f64>) -> (Vec<f64>, f64) {
        let mut row: Vec<f64> =
            self.gram.slopes.iter().map(|slope| support.slope.component_mul(slope).sum()).collect();
        let along: f64 = row.iter().zip(at.iter()).map(|(a, b)| a * b).sum();
        row.extend((0..=self.terms.len()).map(|k| if k == support.term { -1.0 } else { 0.0 }));
        (row, self.terms[support.term] - support.value + along)
    }

    /// Supports at the linearised matrix where it stands above the model.
    fn missing_supports(&self, point: &DVector<f64>) -> Vec<(Vec<f64>, f64)> {
        let change = point.rows(0, self.gram.slopes.len()).into_owned();
        let mut matrix = self.gram.matrix;
        for (slope, share) in self.gram.slopes.iter().zip(change.iter()) {
            matrix += slope * *share;
        }
        let Some(supports) = self.criterion.supports(&matrix, &self.parameter_scale) else {
            return Vec::new();
        };
        let convex = supports.iter().filter(|support| self.criterion.is_convex(support.term));
        convex
            .filter(|support| {
                let modelled = self.terms[support.term] + point[change.len() + support.term];
                support.value > modelled + 1e-9 + 0.02 * (self.terms[support.term] - modelled).abs()
            })
            .map(|support| self.support_row(support, &change))
            .collect()
    }

    fn solve(&mut self, proximal: f64) -> Option<Step> {
        let (width, terms) = (self.gram.slopes.len(), self.terms.len());
        let diagonal =
            DVector::from_fn(
                width + terms + 1,
                |k, _| {
                    if k < width { proximal } else { AUXILIARY_CURVATURE }
                },
            );
        let mut program =
            std::mem::replace(&mut self.program, QuadraticProgram::new(DMatrix::zeros(0, 0), Vec::new()));
        program.curvature = DMatrix::from_diagonal(&diagonal);
        let mut rounds = 0;
        let outcome = program.solve(ROW_TOLERANCE, |program, point| {
            rounds += 1;
            if rounds > SUPPORT_ROUNDS {
                return false;
            }
            let missing = self.missing_supports(point);
            let any = !missing.is_empty();
            for (row, limit) in missing {
                program.push(row, limit);
            }
            any
        });
        self.program = program;
        let QuadraticOutcome::Solved(point) = outcome else {
            return None;
        };
        Some(Step {
            change: point.rows(0, width).into_owned(),
            gain: point.rows(width, terms).sum(),
            violation: point[width + terms].max(0.0),
        })
    }

    /// The step again, with each row's excess set to that of the nonlinear bound at `reached`.
    fn solve_corrected(
        &mut self,
        problem: &Problem,
        reached: &Iterate,
        step: &Step,
        proximal: f64,
    ) -> Option<Step> {
        let kept = self.program.limits.clone();
        for (offset, row) in self.rows.iter().enumerate() {
            let value = reached.values[row.bound][row.instant];
            let seen = row.side.excess(value, &problem.bounds[row.bound]) + self.tightening;
            let along: f64 = row.gradient.iter().zip(step.change.iter()).map(|(a, b)| a * b).sum();
            self.program.limits[self.first_bound_row + offset] = along - seen;
        }
        let corrected = self.solve(proximal);
        self.program.limits[..kept.len()].copy_from_slice(&kept);
        corrected
    }
}

/// Instants around every local maximum and, with coarse steps, everywhere, because a step may also raise a flank.
fn instants_that_matter(values: &[f64], sign: f64) -> impl Iterator<Item = usize> {
    let count = values.len();
    let (near, coarse) = ((count / 50).max(1), (count / 40).max(1));
    let stride = (near / 4).max(1);
    let mut matters: Vec<bool> = (0..count).map(|k| k % coarse == 0).collect();
    let at = |k: usize| sign * values[k % count];
    for peak in 0..count {
        if at(peak) >= at(peak + count - 1) && at(peak) >= at(peak + 1) {
            let around = (peak + count - near..=peak + count + near).step_by(stride);
            for k in around.chain(peak + count - 1..=peak + count + 1) {
                matters[k % count] = true;
            }
        }
    }
    (0..count).filter(move |k| matters[*k])
}
