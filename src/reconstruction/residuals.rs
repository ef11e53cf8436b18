//! Residuals of neighbouring states: what a sensor, or the motion itself, says of them.

use nalgebra::SVector;

use super::arrow::State;

/// Components of a residual; those that are not used stay at nought.
pub const WIDTH: usize = 3;

/// Residuals of one kind.
pub trait Residuals: std::fmt::Debug + Send + Sync {
    /// The interval of each row: its first state.
    fn intervals(&self) -> &[usize];
    /// Of both states, one after the other, the components that the residual depends on.
    fn states(&self) -> &[usize];
    /// The parameters that it depends on, as indices.
    fn parameters(&self) -> &[usize];
    /// One row, not yet divided by its standard deviation.
    fn residual(&self, row: usize, a: &State, b: &State, theta: &[f64]) -> SVector<f64, WIDTH>;
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
    /// name, for reports
    pub name: &'static str,
    /// standard deviation of each component; infinite for one that is not used
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
