//! What is estimated from a flight: its states, its parameters with their priors, its residuals.

use super::blocks::State;
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
    /// all parameters; those that are not free stay at their mean
    pub unknowns: Vec<Unknown>,
    /// index of the group whose derivative by the second state has a determinant that goes with the parameters
    pub process: usize,
}
