//! Mass and inertia of an answer.

/// A parameter with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// in the parameter's unit
    pub value: f64,
    /// standard error; NaN where there is none
    pub std: f64,
    /// the part of it that guesses of the vehicle's description make, which is common to all estimates of these flights
    pub of_guesses: f64,
}

impl Estimate {
    /// Standard error without the part of guesses.
    #[must_use]
    pub fn own_std(&self) -> f64 {
        (self.std.powi(2) - self.of_guesses.powi(2)).max(0.0).sqrt()
    }
}

/// Mass or an entry of the inertia.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyParameter {
    /// as in JSON
    pub name: &'static str,
    /// SI
    pub unit: &'static str,
    /// as the vehicle file states it
    pub nominal: f64,
    /// of the rigid body alone
    pub before: Estimate,
    /// of the final model
    pub after: Estimate,
    /// known beforehand: the vehicle was weighed
    pub weighed: bool,
    /// why the final value is no estimate: these flights do not determine it, and the model keeps a value for
    /// simulations
    pub not_determined: Option<String>,
}
