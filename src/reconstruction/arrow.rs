//! Gauss-Newton on an arrow: states along time, each residual of two neighbours, and parameters that all share.
//!
//! The normal matrix of the states is block tridiagonal and is factorised block by block. The parameters come by its Schur
//! complement. Memory and time grow with the number of states, not with its square.

use nalgebra::{DMatrix, DVector, SVector};
use rayon::prelude::*;

use super::blocks::{Block, Columns, Pair, STATE, State, WIDTH};
use super::residuals::{Group, Residuals};

/// Added to the diagonal so that states which nothing shows stay where they are.
const HOLD: f64 = 1e-9;
/// Rows that one thread takes.
const ROWS_AT_ONCE: usize = 128;
/// Residuals of one group over their standard deviations, and their derivatives.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// one a row
    pub residual: Vec<SVector<f64, WIDTH>>,
    /// by both states, one a row
    pub by_states: Vec<Pair>,
    /// by the group's own parameters, one a row: a column each
    pub by_parameters: Vec<Columns<WIDTH>>,
}

/// The normal equations of all groups.
pub struct Normal {
    /// of each state with itself
    diagonal: Vec<Block>,
    /// of each state with the next
    coupling: Vec<Block>,
    /// of each state with the parameters
    cross: Vec<Columns<STATE>>,
    /// gradient by the states
    state_gradient: Vec<State>,
    /// of the parameters with themselves
    parameters: DMatrix<f64>,
    /// gradient by the parameters
    gradient: DVector<f64>,
    /// sum of squares
    pub cost: f64,
}

/// The states taken out.
#[derive(Debug)]
pub struct Reduced {
    /// inverse pivots of the block factorisation, in order
    pivots: Vec<Block>,
    /// what each pivot passes on to the next: inverse pivot times coupling
    gains: Vec<Block>,
    /// states' answer to each parameter, and in the last column to the gradient
    pub answers: Vec<Columns<STATE>>,
    /// information of the parameters with the states projected out
    pub information: DMatrix<f64>,
    /// gradient by the parameters, likewise
    pub gradient: DVector<f64>,
    /// logarithm of the determinant of the states' normal matrix
    pub log_determinant: f64,
}

impl Rows {
    /// Of a group at states and parameters.
    #[must_use]
    pub fn of(group: &Group, states: &[State], theta: &[f64]) -> Self {
        let form = group.form.as_ref();
        let one = |row: usize| {
            let at = form.intervals()[row];
            let weight = group.weights(row);
            let mut found = form.row(row, &states[at], &states[at + 1], theta);
            found.residual.component_mul_assign(&weight);
            for part in 0..WIDTH {
                found.by_states.row_mut(part).scale_mut(weight[part]);
                found.by_parameters.row_mut(part).scale_mut(weight[part]);
            }
            (found.residual, (found.by_states, found.by_parameters))
        };
        let count = form.intervals().len();
        let (residual, (by_states, by_parameters)) =
            (0..count).into_par_iter().with_min_len(ROWS_AT_ONCE).map(one).unzip();
        Self { residual, by_states, by_parameters }
    }
}

impl Normal {
    /// Of rows of all groups; with no `parameters` that of the states alone.
    #[must_use]
    pub fn of(groups: &[Group], rows: &[Rows], states: usize, parameters: usize) -> Self {
        let mut normal = Self {
            diagonal: vec![Block::identity() * HOLD; states],
            coupling: vec![Block::zeros(); states.saturating_sub(1)],
            cross: vec![Columns::<STATE>::zeros(parameters); states],
            state_gradient: vec![State::zeros(); states],
            parameters: DMatrix::zeros(parameters, parameters),
            gradient: DVector::zeros(parameters),
            cost: 0.0,
        };
        for (group, rows) in groups.iter().zip(rows) {
            normal.add(group.form.as_ref(), rows);
        }
        normal
    }

    fn add(&mut self, form: &dyn Residuals, rows: &Rows) {
        let own = form.parameters();
        for (row, &at) in form.intervals().iter().enumerate() {
            let (residual, by_states) = (&rows.residual[row], &rows.by_states[row]);
            let by_parameters = &rows.by_parameters[row];
            let (first, second) = (
                by_states.fixed_columns::<STATE>(0).into_owned(),
                by_states.fixed_columns::<STATE>(STATE).into_owned(),
            );
            self.diagonal[at] += first.transpose() * first;
            self.diagonal[at + 1] += second.transpose() * second;
            self.coupling[at] += first.transpose() * second;
            self.state_gradient[at] += first.transpose() * residual;
            self.state_gradient[at + 1] += second.transpose() * residual;
            self.cost += residual.norm_squared();
            if self.parameters.is_empty() {
                continue;
            }
            let (one, other) = (first.transpose() * by_parameters, second.transpose() * by_parameters);
            let squares = by_parameters.tr_mul(by_parameters);
            let slope = by_parameters.tr_mul(residual);
            for (column, &parameter) in own.iter().enumerate() {
                let mut into = self.cross[at].column_mut(parameter);
                into += one.column(column);
                let mut into = self.cross[at + 1].column_mut(parameter);
                into += other.column(column);
                self.gradient[parameter] += slope[column];
                for (line, &with) in own.iter().enumerate() {
                    self.parameters[(with, parameter)] += squares[(line, column)];
                }
            }
        }
    }

    /// Takes the states out. `None` where their normal matrix is not positive definite.
    #[must_use]
    pub fn reduced(&self) -> Option<Reduced> {
        let (states, parameters) = (self.diagonal.len(), self.parameters.nrows());
        let (mut pivots, mut gains) = (Vec::with_capacity(states), Vec::with_capacity(states));
        let mut right: Vec<Columns<STATE>> = Vec::with_capacity(states);
        let mut log_determinant = 0.0;
        let mut pivot = *self.diagonal.first()?;
        for at in 0..states {
            if at > 0 {
                let gain: &Block = &gains[at - 1];
                pivot = self.diagonal[at] - self.coupling[at - 1].transpose() * gain;
            }
            let factor = pivot.cholesky()?;
            log_determinant += 2.0 * factor.l_dirty().diagonal().map(f64::ln).sum();
            let inverse = factor.inverse();
            let mut line = Columns::<STATE>::zeros(parameters + 1);
            line.columns_mut(0, parameters).copy_from(&self.cross[at]);
            line.set_column(parameters, &self.state_gradient[at]);
            if at > 0 {
                line -= self.coupling[at - 1].transpose() * (pivots[at - 1] * &right[at - 1]);
            }
            right.push(line);
            pivots.push(inverse);
            if at + 1 < states {
                gains.push(inverse * self.coupling[at]);
            }
        }
        let mut answers = vec![Columns::<STATE>::zeros(parameters + 1); states];
        for at in (0..states).rev() {
            let mut line = pivots[at] * &right[at];
            if at + 1 < states {
                line -= gains[at] * &answers[at + 1];
            }
            answers[at] = line;
        }
        let mut information = self.parameters.clone();
        let mut gradient = self.gradient.clone();
        for (cross, answer) in self.cross.iter().zip(&answers) {
            information -= cross.tr_mul(&answer.columns(0, parameters));
            gradient -= cross.tr_mul(&answer.column(parameters));
        }
        Some(Reduced { pivots, gains, answers, information, gradient, log_determinant })
    }
}

impl Reduced {
    /// Covariance of each two neighbouring states at fixed parameters: of the first, of both, of the second.
    #[must_use]
    pub fn neighbours(&self) -> Vec<[Block; 3]> {
        let Some(mut covariance) = self.pivots.last().copied() else { return Vec::new() };
        let mut all = Vec::with_capacity(self.gains.len());
        for at in (0..self.gains.len()).rev() {
            let gain = self.gains[at];
            let between = -gain * covariance;
            let second = covariance;
            covariance = self.pivots[at] + gain * covariance * gain.transpose();
            all.push([covariance, between, second]);
        }
        all.reverse();
        all
    }

    /// A residual's derivatives by the parameters once the states answer to them, one column a parameter of the problem.
    #[must_use]
    pub fn projected(&self, form: &dyn Residuals, rows: &Rows, row: usize) -> Columns<WIDTH> {
        let parameters = self.information.nrows();
        let at = form.intervals()[row];
        let by_states = &rows.by_states[row];
        let mut out = -(by_states.fixed_columns::<STATE>(0) * self.answers[at].columns(0, parameters)
            + by_states.fixed_columns::<STATE>(STATE) * self.answers[at + 1].columns(0, parameters));
        for (column, &parameter) in form.parameters().iter().enumerate() {
            let mut into = out.column_mut(parameter);
            into += rows.by_parameters[row].column(column);
        }
        out
    }

    /// The states' step for a step of the parameters.
    #[must_use]
    pub fn step(&self, at: usize, parameters: &DVector<f64>) -> State {
        let answer = &self.answers[at];
        let count = parameters.len();
        let moved = answer.columns(0, count) * parameters + answer.column(count);
        -State::from_iterator(moved.iter().copied())
    }
}
