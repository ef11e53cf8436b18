//! Score test of parameters that a fit holds at nought, with the states and the parameters of the fit projected out.

use nalgebra::{DMatrix, DVector};

use super::arrow::{Normal, Rows};
use super::blocks::WIDTH;
use super::fit::{BLOCKS, Fit, FitError, block_of, small_sample};
use super::problem::Problem;

/// What one Gauss-Newton step would do with held parameters of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// step of the held parameters, each in its unit
    pub step: DVector<f64>,
    /// its covariance by the model
    pub covariance: DMatrix<f64>,
    /// its covariance by the scatter of the scores over blocks of time, after the step
    pub robust: DMatrix<f64>,
    /// by how much the sum of the squares falls
    pub gain: f64,
    /// sum of the squares of the fit
    pub cost: f64,
    /// root mean square of the specific force that the step makes, world or body alike, m/s^2
    pub force_m_s2: f64,
}

/// A fit, linearised once more with parameters that it does not have.
#[derive(Debug)]
pub struct Scores {
    problem: Problem,
    rows: Vec<Rows>,
    reduced: super::arrow::Reduced,
    free: Vec<usize>,
    covariance: DMatrix<f64>,
    cost: f64,
}

impl Scores {
    /// About a fit. `problem` is that of the fit with further parameters, which come after those of the fit.
    ///
    /// # Errors
    /// [`FitError::Singular`] where the states are not determined.
    pub fn about(fit: &Fit, mut problem: Problem) -> Result<Self, FitError> {
        problem.states.clone_from(&fit.states);
        for (group, sigma) in problem.groups.iter_mut().zip(&fit.sigma) {
            group.sigma = *sigma;
        }
        let mut theta: Vec<f64> = problem.unknowns.iter().map(|unknown| unknown.mean).collect();
        theta.iter_mut().zip(&fit.theta).for_each(|(value, of_fit)| *value = *of_fit);
        let rows: Vec<Rows> =
            problem.groups.iter().map(|group| Rows::of(group, &problem.states, &theta)).collect();
        let normal = Normal::of(&problem.groups, &rows, problem.states.len(), theta.len());
        let reduced = normal.reduced().ok_or(FitError::Singular)?;
        let (free, covariance) = (fit.free.clone(), fit.covariance.clone());
        Ok(Self { rows, reduced, free, covariance, cost: normal.cost, problem })
    }

    /// Of held parameters together, by index; `None` where the flight does not show them apart from the rest.
    #[must_use]
    pub fn of(&self, held: &[usize]) -> Option<Score> {
        let of = |rows: &[usize], columns: &[usize]| {
            self.reduced.information.select_rows(rows).select_columns(columns)
        };
        let (cross, gradient) = (of(&self.free, held), &self.reduced.gradient);
        let taken = &self.covariance * &cross;
        let information = of(held, held) - cross.tr_mul(&taken);
        let is_shown =
            |at: usize| information[(at, at)] > LEAST_OWN * self.reduced.information[(held[at], held[at])];
        if !(0..held.len()).all(is_shown) {
            return None;
        }
        // the fit is at its mode: the gradient by its own parameters is nought
        let own = DVector::from_iterator(held.len(), held.iter().map(|&index| gradient[index]));
        let covariance = information.cholesky()?.inverse();
        let step = -(&covariance * &own);
        let gain = -own.dot(&step);
        let (scores, force_m_s2) = self.by_block(held, &taken, &step);
        let robust = &covariance * scores.tr_mul(&scores) * &covariance * small_sample();
        Some(Score { step, covariance, robust, gain, cost: self.cost, force_m_s2 })
    }

    /// Scores after the step, one row a block of time, and the force that the step makes.
    fn by_block(&self, held: &[usize], taken: &DMatrix<f64>, step: &DVector<f64>) -> (DMatrix<f64>, f64) {
        let mut scores = DMatrix::zeros(BLOCKS, held.len());
        let all: Vec<usize> = held.iter().chain(&self.free).copied().collect();
        let mut lines: [Vec<f64>; WIDTH] = Default::default();
        let (mut squares, mut count) = (0.0, 0.0);
        for (index, (group, rows)) in self.problem.groups.iter().zip(&self.rows).enumerate() {
            let form = group.form.as_ref();
            for (row, &at) in form.intervals().iter().enumerate() {
                self.reduced.project(form, rows, (row, &all), &mut lines);
                let block = block_of(&self.problem.time_s, at);
                for (part, line) in lines.iter_mut().enumerate() {
                    let (own, free) = line.split_at_mut(held.len());
                    for (column, own) in own.iter_mut().enumerate() {
                        *own -= taken.column(column).iter().zip(free.iter()).map(|(a, b)| a * b).sum::<f64>();
                    }
                    let moved: f64 = own.iter().zip(step.iter()).map(|(a, b)| a * b).sum();
                    let left = rows.residual[row][part] + moved;
                    own.iter().enumerate().for_each(|(column, own)| scores[(block, column)] += own * left);
                }
                if index == self.problem.process {
                    squares += self.made(form.parameters(), (rows, row), (held, step), &group.weights(row));
                    count += 1.0;
                }
            }
        }
        (scores, (squares / f64::max(count, 1.0)).sqrt())
    }

    /// Square of the specific force that a step makes in a row, (m/s^2)^2.
    fn made(
        &self,
        parameters: &[usize],
        (rows, row): (&Rows, usize),
        (held, step): (&[usize], &DVector<f64>),
        weights: &nalgebra::SVector<f64, WIDTH>,
    ) -> f64 {
        let part = |part: usize| {
            let sum: f64 = held
                .iter()
                .zip(step.iter())
                .filter_map(|(index, by)| {
                    let column = parameters.iter().position(|own| own == index)?;
                    Some(rows.by_parameters[row][(part, column)] * by)
                })
                .sum();
            (sum / weights[part]).powi(2)
        };
        (0..WIDTH).map(part).sum()
    }
}

/// A parameter of which less of the information than this is its own is not told apart from the states and the rest.
const LEAST_OWN: f64 = 1e-6;

impl Score {
    /// Chi squared of the step: the lesser of that by the model and that by the blocks.
    #[must_use]
    pub fn chi_squared(&self) -> f64 {
        let of = |covariance: &DMatrix<f64>| {
            let mut held = covariance.clone();
            for at in 0..held.nrows() {
                held[(at, at)] += HOLD * self.covariance[(at, at)];
            }
            held.cholesky().map_or(0.0, |factor| self.step.dot(&factor.solve(&self.step)))
        };
        of(&self.covariance).min(of(&self.robust))
    }

    /// Share of the sum of the squares that the step takes.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.gain / self.cost
    }
}

/// Added to a diagonal, as a share of the covariance by the model: few blocks make a covariance that is nearly singular.
const HOLD: f64 = 1e-6;
