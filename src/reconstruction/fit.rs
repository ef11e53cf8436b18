//! Joint maximum a posteriori fit of states, parameters and noise levels.

use nalgebra::{DMatrix, DVector, SVector};

use super::arrow::{Normal, Reduced, Rows, by_states, rows_of, spread};
use super::blocks::{Block, Pair, STATE, WIDTH};
use super::places::{BASE, SCALE};
use super::problem::{Path, Problem, Unknown};
use super::residuals::Group;

/// Blocks of time over which scores are summed for standard errors.
pub const BLOCKS: usize = 12;
/// Rounds of Gauss-Newton at most. A limit of time: it ends fits that alternate.
const ROUNDS: usize = 14;
/// Round from which on noise levels stay. The last rounds need a criterion that does not change, or they would not
/// converge.
const LEARNED_UNTIL: usize = 9;
/// Round that a fit begins with where it begins at the path of another one. Its levels stay: learned on and on they would move along the
/// ridge of process and accelerometer, and the scale with them.
const FROM_PATH: usize = LEARNED_UNTIL;
/// A step smaller than this share of every standard error ends the fit.
const SMALL: f64 = 0.01;
/// A fit whose last step was larger than this many standard errors has not converged.
const FAR: f64 = 2.0;
/// Share of a standard error by which parameters are moved for the slope of the determinant.
const PROBE: f64 = 0.3;
/// A noise level changes by no more than this factor in its square in one round. A larger step lets a level that is
/// estimated from a bad first state run away.
const LEAPS: (f64, f64) = (0.2, 5.0);
/// States and parameters take at most this share of the rows of a component: its level is not learned from less. Of
/// the remaining fiftieth a level would be known no better than to its own size.
const TAKEN_MOST: f64 = 0.98;

/// The result.
#[derive(Debug)]
pub struct Fit {
    /// s
    pub time_s: Vec<f64>,
    /// all parameters
    pub theta: Vec<f64>,
    /// indices of those that were free
    pub free: Vec<usize>,
    /// of the free ones, by the model
    pub covariance: DMatrix<f64>,
    /// of the free ones, by the scatter of the scores over blocks of time
    pub robust: DMatrix<f64>,
    /// where a fit with other effects may begin
    pub path: Path,
    unknowns: Vec<Unknown>,
    rows: Vec<Rows>,
    reduced: Reduced,
}

/// Why there is no fit.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// states or parameters that nothing determines
    #[error(
        "expected data that determine all states and parameters, got a normal matrix that is not positive definite"
    )]
    Singular,
    /// its steps do not end
    #[error("expected a fit that converges, got steps that stay larger than their standard errors")]
    Diverged,
}

/// One linearisation.
struct Turn {
    rows: Vec<Rows>,
    reduced: Reduced,
    /// of the free parameters
    covariance: DMatrix<f64>,
    step: DVector<f64>,
}

/// What is iterated.
struct Iterate<'a> {
    problem: Problem,
    free: &'a [usize],
    theta: Vec<f64>,
    first_round: usize,
}

impl<'a> Iterate<'a> {
    fn new(mut problem: Problem, free: &'a [usize]) -> Self {
        let mut theta: Vec<f64> = problem.unknowns.iter().map(|unknown| unknown.mean).collect();
        let Some(path) = problem.path.take() else { return Self { problem, free, theta, first_round: 0 } };
        theta.iter_mut().zip(&path.theta).for_each(|(value, found)| *value = *found);
        problem.states = path.states;
        problem.groups.iter_mut().zip(path.sigma).for_each(|(group, sigma)| group.sigma = sigma);
        Self { problem, free, theta, first_round: FROM_PATH }
    }

    /// To the joint mode, with noise levels that are learned on the way.
    fn mode(&mut self) -> Result<(), FitError> {
        for round in self.first_round..ROUNDS {
            let turn = self.linearised()?;
            self.moved(&turn);
            if round > 1 && round < LEARNED_UNTIL {
                self.learn(&turn, round);
            }
            let is_small = |(at, step): (usize, &f64)| step.abs() < SMALL * turn.covariance[(at, at)].sqrt();
            if round >= LEARNED_UNTIL && turn.step.iter().enumerate().all(is_small) {
                break;
            }
            let wanders = |(at, step): (usize, &f64)| {
                is_wanted(self.free[at]) && step.abs() > FAR * turn.covariance[(at, at)].sqrt()
            };
            if round + 1 == ROUNDS && turn.step.iter().enumerate().any(wanders) {
                return Err(FitError::Diverged);
            }
        }
        Ok(())
    }

    fn finished(self) -> Result<Fit, FitError> {
        let Turn { rows, reduced, covariance, .. } = self.linearised()?;
        let Self { problem, free, theta, .. } = self;
        let robust = DMatrix::zeros(0, 0);
        let Problem { time_s, states, groups, unknowns, .. } = problem;
        let sigma = groups.iter().map(|group| group.sigma).collect();
        let path =
            Path { time_s: time_s.clone(), states, sigma, theta: theta.iter().take(BASE).copied().collect() };
        let mut fit =
            Fit { time_s, theta, free: free.to_vec(), covariance, robust, path, unknowns, rows, reduced };
        let scores = fit.scores(&groups, free);
        fit.robust = &fit.covariance * scores.tr_mul(&scores) * &fit.covariance * small_sample();
        for name in fit.unknowns.iter().take(BASE).map(|unknown| unknown.name) {
            let Some((value, std, std_by_blocks)) = fit.value(name) else { continue };
            tracing::debug!(name, value, std, std_by_blocks, "flight path");
        }
        Ok(fit)
    }

    fn linearised(&self) -> Result<Turn, FitError> {
        let Problem { groups, states, unknowns, .. } = &self.problem;
        let rows: Vec<Rows> = groups.iter().map(|group| rows_of(group, states, &self.theta)).collect();
        let normal = Normal::of(groups, &rows, states.len(), unknowns.len());
        let reduced = normal.reduced().ok_or(FitError::Singular)?;
        let precision = |index: usize| unknowns[index].std.powi(-2);
        let mut information = selected(&reduced.information, self.free);
        let mut gradient = DVector::zeros(self.free.len());
        for (at, &index) in self.free.iter().enumerate() {
            information[(at, at)] += precision(index);
            gradient[at] =
                reduced.gradient[index] + precision(index) * (self.theta[index] - unknowns[index].mean);
        }
        let covariance = information.try_inverse().ok_or(FitError::Singular)?;
        let step = -(&covariance * gradient);
        if step.iter().all(|part| part.is_finite()) {
            Ok(Turn { rows, reduced, covariance, step })
        } else {
            Err(FitError::Diverged)
        }
    }

    fn moved(&mut self, turn: &Turn) {
        let mut all = DVector::zeros(self.theta.len());
        for (at, &index) in self.free.iter().enumerate() {
            self.theta[index] += turn.step[at];
            all[index] = turn.step[at];
        }
        for (at, state) in self.problem.states.iter_mut().enumerate() {
            *state += turn.reduced.step(at, &all);
        }
    }

    /// Noise levels by MacKay's fixed point: `sigma^2 <- sum r^2 / (rows - what states and parameters took of them)`.
    fn learn(&mut self, turn: &Turn, round: usize) {
        let learns = |group: &Group| {
            let (first, last) = group.learned_in;
            group.floor.is_some() && (first..=last).contains(&round)
        };
        if !self.problem.groups.iter().any(learns) {
            return;
        }
        let neighbours = turn.reduced.neighbours();
        for (group, rows) in self.problem.groups.iter_mut().zip(&turn.rows) {
            let (first, last) = group.learned_in;
            let Some(floor) = group.floor.filter(|_| (first..=last).contains(&round)) else { continue };
            let mut taken = SVector::<f64, WIDTH>::zeros();
            let mut squares = SVector::<f64, WIDTH>::zeros();
            let (count, form) = (rows.len() as f64, group.form.as_ref());
            let mut projected = Vec::new();
            for (row, (of_row, &at)) in rows.iter().zip(form.intervals()).enumerate() {
                turn.reduced.project(form, (row, of_row), self.free, &mut projected);
                taken += taken_by_parameters(&projected, &turn.covariance);
                for part in 0..WIDTH {
                    taken[part] += taken_by_states(&of_row.by_states, part, &neighbours[at]);
                    squares[part] += of_row.residual[part].powi(2);
                }
            }
            for part in 0..WIDTH {
                let ratio = squares[part] / (count - taken[part]).max((1.0 - TAKEN_MOST) * count);
                let factor = ratio.clamp(LEAPS.0, LEAPS.1).sqrt();
                if group.sigma[part].is_finite() {
                    group.sigma[part] = (group.sigma[part] * factor).max(floor[part]);
                }
            }
        }
    }

    /// Slope, by each free parameter, of half the logarithm of the determinant that the states leave behind when they are integrated
    /// out: that of their normal matrix, less that of the process by its second state, which goes with the parameters too.
    fn slope_of_determinant(&self, here: &Turn) -> DVector<f64> {
        let Problem { groups, states, process, .. } = &self.problem;
        let neighbours = here.reduced.neighbours();
        // of J'J it goes by what its inverse and J make of a change of J
        let spreads = groups.iter().zip(&here.rows).map(|(group, rows)| -> Vec<Pair> {
            let is_shaped = group.form.shaped_by().iter().any(|index| self.free.contains(index));
            let each = rows.iter().zip(group.form.intervals()).filter(|_| is_shaped);
            each.map(|(row, &at)| spread(&row.by_states, &neighbours[at])).collect()
        });
        let spreads: Vec<Vec<Pair>> = spreads.collect();
        let mut slope = DVector::zeros(self.free.len());
        let mut theta = self.theta.clone();
        for (at, &index) in self.free.iter().enumerate() {
            let probe = PROBE * here.covariance[(at, at)].sqrt();
            let mut moved = |group: &Group, by: f64| {
                theta[index] = self.theta[index] + by;
                let found = by_states(group, states, &theta);
                theta[index] = self.theta[index];
                found
            };
            for (place, group) in groups.iter().enumerate() {
                if !group.form.shaped_by().contains(&index) {
                    continue;
                }
                let (up, down) = (moved(group, probe), moved(group, -probe));
                let sides = up.iter().zip(&down);
                let of_row = |((up, down), spread): ((&Pair, &Pair), &Pair)| spread.dot(&(up - down));
                slope[at] += sides.zip(&spreads[place]).map(of_row).sum::<f64>() / (2.0 * probe);
                if place == *process {
                    let ahead = |pairs: &[Pair]| -> f64 {
                        let determinant =
                            |pair: &Pair| pair.fixed_view::<WIDTH, WIDTH>(0, STATE).determinant();
                        pairs.iter().map(|pair| determinant(pair).abs().ln()).sum()
                    };
                    slope[at] -= (ahead(&up) - ahead(&down)) / (2.0 * probe);
                }
            }
        }
        slope
    }

    /// From the joint mode to the mode with the states integrated out, by Laplace: the slope of the determinant moves the
    /// parameters.
    fn marginal(&mut self) -> Result<(), FitError> {
        let here = self.linearised()?;
        let step = &here.step - &here.covariance * self.slope_of_determinant(&here);
        self.moved(&Turn { step, ..here });
        Ok(())
    }
}

/// Share of one component of a residual that the two states took, of which these are the covariances.
fn taken_by_states(pair: &Pair, part: usize, [one, between, other]: &[Block; 3]) -> f64 {
    let (a, b) = (pair.fixed_view::<1, STATE>(part, 0), pair.fixed_view::<1, STATE>(part, STATE));
    // most derivatives are zero
    let of_column = |column: usize| {
        let (mut sum, by_a, by_b) = (0.0, a[column], b[column]);
        if by_a != 0.0 {
            sum += a.tr_dot(&one.column(column)) * by_a;
        }
        if by_b != 0.0 {
            sum += a.tr_dot(&between.column(column)) * by_b * 2.0;
            sum += b.tr_dot(&other.column(column)) * by_b;
        }
        sum
    };
    (0..STATE).map(of_column).sum()
}

/// The same of the parameters, of all components.
fn taken_by_parameters(projected: &[SVector<f64, WIDTH>], covariance: &DMatrix<f64>) -> SVector<f64, WIDTH> {
    let mut sum = SVector::zeros();
    for (at, (column, own)) in covariance.column_iter().zip(projected).enumerate() {
        // each pair counts twice
        let mut with = own * (0.5 * column[at]);
        projected.iter().zip(column.iter()).take(at).for_each(|(other, shared)| with += other * *shared);
        sum += with.component_mul(own) * 2.0;
    }
    sum
}

/// Scale and effects, for which the fit is made; the others are nuisances. A lag at nought, for one, goes to and fro.
fn is_wanted(parameter: usize) -> bool {
    parameter == SCALE || parameter >= BASE
}

fn selected(matrix: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    matrix.select_rows(of).select_columns(of)
}

/// Fits the states and the parameters `free` (indices), learns the noise levels, and goes from the joint mode to that with the
/// states integrated out.
///
/// # Errors
/// [`FitError`] where the data do not determine them.
pub fn fit(problem: Problem, free: &[usize]) -> Result<Fit, FitError> {
    let mut iterate = Iterate::new(problem, free);
    iterate.mode()?;
    iterate.marginal()?;
    iterate.finished()
}

/// The same up to the joint mode, which is what a choice between forms needs.
///
/// # Errors
/// As [`fit`].
pub fn fit_mode(problem: Problem, free: &[usize]) -> Result<Fit, FitError> {
    let mut iterate = Iterate::new(problem, free);
    iterate.mode()?;
    iterate.finished()
}

/// Factor on a covariance from so few blocks (Bell and McCaffrey 2002).
fn small_sample() -> f64 {
    BLOCKS as f64 / (BLOCKS as f64 - 1.0)
}

impl Fit {
    /// Value, standard error by the model and by blocks of a free parameter.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<(f64, f64, f64)> {
        let at = self.free.iter().position(|&index| self.unknowns[index].name == name)?;
        let std = |covariance: &DMatrix<f64>| covariance[(at, at)].sqrt();
        Some((self.theta[self.free[at]], std(&self.covariance), std(&self.robust)))
    }

    /// Scale and values of the effects with their covariance: correlations by the model, standard errors the larger of the
    /// model's and those of the blocks.
    #[must_use]
    pub fn scale_and_effects(&self) -> (DVector<f64>, DMatrix<f64>) {
        let wanted: Vec<usize> = (0..self.free.len()).filter(|&at| is_wanted(self.free[at])).collect();
        let values = DVector::from_iterator(wanted.len(), wanted.iter().map(|&at| self.theta[self.free[at]]));
        let model = selected(&self.covariance, &wanted);
        let larger = |&at: &usize| (self.robust[(at, at)] / self.covariance[(at, at)]).max(1.0).sqrt();
        let factors = DVector::from_iterator(wanted.len(), wanted.iter().map(larger));
        (values, model.component_mul(&(&factors * factors.transpose())))
    }

    /// Scores of parameters with the states projected out, summed over blocks of time: one row a block.
    fn scores(&self, groups: &[Group], of: &[usize]) -> DMatrix<f64> {
        let (Some(first), Some(last)) = (self.time_s.first(), self.time_s.last()) else {
            return DMatrix::zeros(BLOCKS, of.len());
        };
        let block_of = |at: usize| {
            let share = (self.time_s[at] - first) / (last - first);
            (1..BLOCKS).take_while(|block| share * BLOCKS as f64 >= *block as f64).count()
        };
        let mut scores = DMatrix::zeros(BLOCKS, of.len());
        let mut projected = Vec::new();
        for (group, rows) in groups.iter().zip(&self.rows) {
            let form = group.form.as_ref();
            for (row, (of_row, &at)) in rows.iter().zip(form.intervals()).enumerate() {
                self.reduced.project(form, (row, of_row), of, &mut projected);
                let block = block_of(at);
                for (column, projected) in projected.iter().enumerate() {
                    scores[(block, column)] += projected.dot(&of_row.residual);
                }
            }
        }
        scores
    }
}
