//! Residuals between neighbouring states: from a sensor, or from the equation of motion.

use nalgebra::SVector;

use super::blocks::{Columns, Pair, State, WIDTH};

/// One residual and its derivatives, not yet divided by its standard deviation.
#[derive(Debug, Clone)]
pub struct Row {
    /// what is left
    pub residual: SVector<f64, WIDTH>,
    /// by both states, one after the other
    pub by_states: Pair,
    /// by [`Residuals::parameters`], a column each
    pub by_parameters: Columns<WIDTH>,
}

/// Residuals of one kind.
pub trait Residuals: std::fmt::Debug + Send + Sync {
    /// The interval of each row: its first state.
    fn intervals(&self) -> &[usize];
    /// The parameters that it depends on, as indices.
    fn parameters(&self) -> &[usize];
    /// One row at two neighbouring states.
    fn row(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Row;
    /// The parameters that its derivatives by the states depend on, of [`Self::parameters`].
    fn shaped_by(&self) -> &[usize] {
        self.parameters()
    }
    /// The derivatives by the states alone.
    fn by_states(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> Pair {
        self.row(row, a, b, theta).by_states
    }
    /// What the standard deviation of a row is divided by: the root of the number of samples in a mean.
    fn weight(&self, _row: usize) -> f64 {
        1.0
    }
}

/// Residuals with their noise.
#[derive(Debug)]
pub struct Group {
    /// the equation
    pub form: Box<dyn Residuals>,
    /// standard deviation of each component
    pub sigma: SVector<f64, WIDTH>,
    /// it is learned, and not below this
    pub floor: Option<SVector<f64, WIDTH>>,
    /// first and last round in which it is learned
    pub learned_in: (usize, usize),
}

impl Group {
    /// Reciprocal standard deviations of a row.
    #[must_use]
    pub fn weights(&self, row: usize) -> SVector<f64, WIDTH> {
        self.sigma.map(|sigma| 1.0 / sigma) * self.form.weight(row)
    }
}
