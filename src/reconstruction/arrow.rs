//! Gauss-Newton on an arrow: states along time, each residual of two neighbours, and parameters that all share.
//!
//! The normal matrix of the states is block tridiagonal and is factorised block by block. The parameters come by its Schur
//! complement. Memory and time grow with the number of states, not with its square.

use nalgebra::{DMatrix, DVector, Matrix3, SVector};
use rayon::prelude::*;

use super::blocks::{Block, Columns, Pair, STATE, State, WIDTH};
use super::residuals::{Group, Residuals, Row};

/// Added to the diagonal so that states which nothing shows stay where they are. It has to exceed rounding and to
/// stay far below the information of any sensor, which is 1 and more.
const HOLD: f64 = 1e-9;
/// Rows that one thread takes.
const ROWS_AT_ONCE: usize = 128;
/// Residuals of one group over their standard deviations, and their derivatives by both states and the group's own parameters.
pub type Rows = Vec<Row>;

/// The normal matrix of the states.
#[derive(Debug, Clone)]
pub struct Chain {
    /// of each state with itself
    diagonal: Vec<Block>,
    /// of each state with the next
    coupling: Vec<Block>,
}

/// The normal equations of all groups.
pub struct Normal {
    chain: Chain,
    /// of each state with the parameters
    cross: Vec<Columns<STATE>>,
    /// gradient by the states
    state_gradient: Vec<State>,
    /// of the parameters with themselves
    parameters: DMatrix<f64>,
    /// gradient by the parameters
    gradient: DVector<f64>,
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
}

/// Rows of a group at states and parameters.
#[must_use]
pub fn rows_of(group: &Group, states: &[State], theta: &[f64]) -> Rows {
    let form = group.form.as_ref();
    let one = |row: usize| {
        let at = form.intervals()[row];
        let weight = group.weights(row);
        let mut found = form.row(row, &states[at], &states[at + 1], theta);
        found.residual.component_mul_assign(&weight);
        weigh(&mut found.by_states, &weight);
        for mut column in found.by_parameters.column_iter_mut() {
            column.component_mul_assign(&weight);
        }
        found
    };
    (0..form.intervals().len()).into_par_iter().with_min_len(ROWS_AT_ONCE).map(one).collect()
}

fn weigh(by_states: &mut Pair, weight: &SVector<f64, WIDTH>) {
    by_states.column_iter_mut().for_each(|mut column| column.component_mul_assign(weight));
}

/// Parts of [`WIDTH`] components of a state.
const PARTS: usize = STATE / WIDTH;

/// Derivatives of one residual by the parts of both neighbouring states.
struct Blocks {
    each: [Matrix3<f64>; 2 * PARTS],
    is_held: [bool; 2 * PARTS],
}

impl Blocks {
    fn of(by_states: &Pair) -> Self {
        let each: [Matrix3<f64>; 2 * PARTS] =
            std::array::from_fn(|block| by_states.fixed_view::<WIDTH, WIDTH>(0, WIDTH * block).into_owned());
        let is_held = each.each_ref().map(|block| block.iter().any(|value| *value != 0.0));
        Self { each, is_held }
    }

    /// Those that are not zero.
    fn held(&self) -> impl Iterator<Item = usize> + Clone {
        let is_held = self.is_held;
        (0..2 * PARTS).filter(move |block| is_held[*block])
    }
}

impl Chain {
    /// Of so many states that nothing shows.
    #[must_use]
    pub fn of(states: usize) -> Self {
        Self {
            diagonal: vec![Block::identity() * HOLD; states],
            coupling: vec![Block::zeros(); states.saturating_sub(1)],
        }
    }

    fn add(&mut self, at: usize, blocks: &Blocks) {
        for one in blocks.held() {
            for other in blocks.held().filter(|other| *other >= one) {
                let product = blocks.each[one].tr_mul(&blocks.each[other]);
                let (row, column) = (WIDTH * (one % PARTS), WIDTH * (other % PARTS));
                let put = |to: &mut Block, (row, column), product: &Matrix3<f64>| {
                    let mut into = to.fixed_view_mut::<WIDTH, WIDTH>(row, column);
                    into += product;
                };
                if one / PARTS != other / PARTS {
                    put(&mut self.coupling[at], (row, column), &product);
                    continue;
                }
                let diagonal = &mut self.diagonal[at + one / PARTS];
                put(diagonal, (row, column), &product);
                if one != other {
                    put(diagonal, (column, row), &product.transpose());
                }
            }
        }
    }
}

/// Derivatives of a group's residuals by the states alone, over their standard deviations.
#[must_use]
pub fn by_states(group: &Group, states: &[State], theta: &[f64]) -> Vec<Pair> {
    let form = group.form.as_ref();
    let one = |row: usize| {
        let at = form.intervals()[row];
        let weight = group.weights(row);
        let mut found = form.by_states(row, &states[at], &states[at + 1], theta);
        weigh(&mut found, &weight);
        found
    };
    (0..form.intervals().len()).into_par_iter().with_min_len(ROWS_AT_ONCE).map(one).collect()
}

impl Normal {
    /// Of rows of all groups.
    #[must_use]
    pub fn of(groups: &[Group], rows: &[Rows], states: usize, parameters: usize) -> Self {
        let mut normal = Self {
            chain: Chain::of(states),
            cross: vec![Columns::<STATE>::zeros(parameters); states],
            state_gradient: vec![State::zeros(); states],
            parameters: DMatrix::zeros(parameters, parameters),
            gradient: DVector::zeros(parameters),
        };
        for (group, rows) in groups.iter().zip(rows) {
            normal.add(group.form.as_ref(), rows);
        }
        normal
    }

    fn add(&mut self, form: &dyn Residuals, rows: &Rows) {
        let own = form.parameters();
        for (Row { residual, by_states, by_parameters }, &at) in rows.iter().zip(form.intervals()) {
            let blocks = Blocks::of(by_states);
            self.chain.add(at, &blocks);
            for block in blocks.held() {
                let slope = blocks.each[block].tr_mul(residual);
                let mut into =
                    self.state_gradient[at + block / PARTS].fixed_rows_mut::<WIDTH>(WIDTH * (block % PARTS));
                into += slope;
            }
            for (column, &parameter) in own.iter().enumerate() {
                let by_parameter: SVector<f64, WIDTH> = by_parameters.fixed_columns::<1>(column).into_owned();
                for block in blocks.held() {
                    let product = blocks.each[block].tr_mul(&by_parameter);
                    let cross = self.cross[at + block / PARTS].as_mut_slice();
                    let first = STATE * parameter + WIDTH * (block % PARTS);
                    cross[first..first + WIDTH].iter_mut().zip(&product).for_each(|(to, value)| *to += value);
                }
                self.gradient[parameter] += by_parameter.dot(residual);
                for (line, &with) in own.iter().enumerate().take(column + 1) {
                    let product = by_parameters.fixed_columns::<1>(line).dot(&by_parameter);
                    self.parameters[(with, parameter)] += product;
                    if line != column {
                        self.parameters[(parameter, with)] += product;
                    }
                }
            }
        }
    }

    /// Takes the states out. `None` where their normal matrix is not positive definite.
    #[must_use]
    pub fn reduced(&self) -> Option<Reduced> {
        let Chain { diagonal, coupling } = &self.chain;
        let (states, parameters) = (diagonal.len(), self.parameters.nrows());
        let (mut pivots, mut gains) = (Vec::with_capacity(states), Vec::with_capacity(states));
        // inverse pivot times what is left on the right
        let mut solved: Vec<Columns<STATE>> = Vec::with_capacity(states);
        let mut pivot = *diagonal.first()?;
        for at in 0..states {
            if at > 0 {
                let gain: &Block = &gains[at - 1];
                pivot = diagonal[at] - coupling[at - 1].transpose() * gain;
            }
            let inverse = pivot.cholesky()?.inverse();
            let mut line = Columns::<STATE>::zeros(parameters + 1);
            line.columns_mut(0, parameters).copy_from(&self.cross[at]);
            line.set_column(parameters, &self.state_gradient[at]);
            if at > 0 {
                take_product(&mut line, &coupling[at - 1].transpose(), &solved[at - 1]);
            }
            let mut line_solved = Columns::<STATE>::zeros(parameters + 1);
            take_product(&mut line_solved, &-inverse, &line);
            solved.push(line_solved);
            pivots.push(inverse);
            if at + 1 < states {
                gains.push(inverse * coupling[at]);
            }
        }
        let mut answers = solved;
        for at in (0..states.saturating_sub(1)).rev() {
            let (before, after) = answers.split_at_mut(at + 1);
            take_product(&mut before[at], &gains[at], &after[0]);
        }
        let mut information = self.parameters.clone();
        let mut gradient = self.gradient.clone();
        for (cross, answer) in self.cross.iter().zip(&answers) {
            information -= cross.tr_mul(&answer.columns(0, parameters));
            gradient -= cross.tr_mul(&answer.column(parameters));
        }
        Some(Reduced { pivots, gains, answers, information, gradient })
    }
}

/// Takes `matrix * columns` from `from`, column by column: for matrices of this size no other product is faster.
fn take_product(from: &mut Columns<STATE>, matrix: &Block, columns: &Columns<STATE>) {
    let each = from.as_mut_slice().chunks_exact_mut(STATE).zip(columns.as_slice().chunks_exact(STATE));
    for (to, column) in each {
        let product = matrix * State::from_column_slice(column);
        to.iter_mut().zip(&product).for_each(|(to, value)| *to -= value);
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
            let carried = gain * covariance;
            let second = covariance;
            covariance = self.pivots[at] + carried * gain.transpose();
            all.push([covariance, -carried, second]);
        }
        all.reverse();
        all
    }

    /// A residual's derivatives by the parameters `of` once the states answer to them: one each.
    pub fn project(
        &self,
        form: &dyn Residuals,
        (row, of_row): (usize, &Row),
        of: &[usize],
        into: &mut Vec<SVector<f64, WIDTH>>,
    ) {
        let at = form.intervals()[row];
        let by_first = of_row.by_states.fixed_view::<WIDTH, STATE>(0, 0).into_owned();
        let by_second = of_row.by_states.fixed_view::<WIDTH, STATE>(0, STATE).into_owned();
        let (first, second) = (self.answers[at].as_slice(), self.answers[at + 1].as_slice());
        into.clear();
        into.extend(of.iter().map(|&parameter| {
            let of = |all: &[f64]| State::from_column_slice(&all[STATE * parameter..STATE * (parameter + 1)]);
            -(by_first * of(first) + by_second * of(second))
        }));
        for (column, parameter) in form.parameters().iter().enumerate() {
            let Some(place) = of.iter().position(|of| of == parameter) else { continue };
            into[place] += of_row.by_parameters.fixed_columns::<1>(column);
        }
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

/// A residual's derivatives by both states times the covariance of these, as [`Reduced::neighbours`] has it.
#[must_use]
pub fn spread(by_states: &Pair, [one, between, other]: &[Block; 3]) -> Pair {
    let by_first = by_states.fixed_view::<WIDTH, STATE>(0, 0);
    let by_second = by_states.fixed_view::<WIDTH, STATE>(0, STATE);
    let mut out = Pair::zeros();
    out.fixed_view_mut::<WIDTH, STATE>(0, 0).copy_from(&(by_first * one + by_second * between.transpose()));
    out.fixed_view_mut::<WIDTH, STATE>(0, STATE).copy_from(&(by_first * between + by_second * other));
    out
}
