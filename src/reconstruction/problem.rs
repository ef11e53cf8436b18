//! What is estimated from a flight: its states, its parameters with their priors, its residuals.

use nalgebra::SVector;

use super::blocks::{State, WIDTH};
use super::residuals::Group;

/// A parameter with what is known of it beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unknown {
    /// for reports
    pub name: &'static str,
    /// where the fit begins, and the mean of the prior
    pub mean: f64,
    /// standard deviation of the prior; infinite where nothing is known
    pub std: f64,
}

/// States along time, residuals and parameters.
#[derive(Debug)]
pub struct Problem {
    /// s, one a state
    pub time_s: Vec<f64>,
    /// where the fit begins
    pub states: Vec<State>,
    /// all residuals
    pub groups: Vec<Group>,
    /// what an earlier fit of the same flight found: the fit begins there
    pub path: Option<Path>,
    /// all parameters; those that are not free stay at their mean
    pub unknowns: Vec<Unknown>,
    /// index of the group whose derivative by the second state has a determinant that goes with the parameters
    pub process: usize,
}

/// A flight path that a fit found. A fit of the same flight with other effects begins there: few rounds are left.
#[derive(Debug, Clone)]
pub struct Path {
    pub(super) time_s: Vec<f64>,
    pub(super) states: Vec<State>,
    /// noise level of each group
    pub(super) sigma: Vec<SVector<f64, WIDTH>>,
    /// the parameters that every problem has
    pub(super) theta: Vec<f64>,
}

impl Problem {
    /// Begins where an earlier fit ended, if that was of these instants.
    #[must_use]
    pub fn from_path(mut self, path: Option<&Path>) -> Self {
        self.path =
            path.filter(|path| path.time_s == self.time_s && path.sigma.len() == self.groups.len()).cloned();
        self
    }
}
