//! What one may want to know of a vehicle, as values.

use crate::estimate::POOR;
use serde::Serialize;

/// What the log will tell of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantitySummary {
    /// `mass`, `inertia`, `thrust_curve`, `motor_lag`, `drag`, `wind`, `centre_of_mass`, `rotor_efficiency`, `voltage_sag`
    pub name: &'static str,
    /// `yes`; `partly`: some of its parameters; `possible`: nothing speaks against it, and how well is not known; `no`
    pub status: &'static str,
    /// standard errors to expect
    pub expected: Vec<ExpectedParameter>,
    /// they come from the liveliest two minutes: all of the flight tells more
    pub at_most: bool,
    /// why not, or why not all of it
    pub reason: Option<String>,
    /// what to fly for it
    pub fly: Option<&'static str>,
    /// what to have recorded for it
    pub set: Option<String>,
}

impl QuantitySummary {
    /// Share of its parameters, 0 to 1, whose standard error is one with which `identify` calls them poor.
    #[must_use]
    pub fn poor_share(&self) -> f64 {
        let poor = self.expected.iter().filter(|one| one.of == "value" && one.std_relative > POOR).count();
        poor as f64 / self.expected.len().max(1) as f64
    }
}

/// How well a parameter will be known.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExpectedParameter {
    /// as in `identify` and `explain`
    pub parameter: &'static str,
    /// standard error; none where mass or size, on which it depends, is not given
    pub std: Option<f64>,
    /// of that
    pub unit: &'static str,
    /// standard error over the size that `of` names
    pub std_relative: f64,
    /// `value`: the parameter's own; `usual`: that on ordinary vehicles
    pub of: &'static str,
}
