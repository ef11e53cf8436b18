//! Each parameter by both ways.

/// The joint refit.
#[derive(Debug, Clone)]
pub struct Refit {
    /// every estimated parameter
    pub parameters: Vec<Refitted>,
    /// segments that were simulated
    pub segments: usize,
    /// mean squared residual over its own noise, at the start and at the end
    pub cost: (f64, f64),
}

/// One parameter by both ways.
#[derive(Debug, Clone, PartialEq)]
pub struct Refitted {
    /// `mass`, `ixx` ..., `latency`, or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// by the weak form
    pub weak: f64,
    /// its standard error
    pub weak_std: f64,
    /// by multiple shooting
    pub shooting: f64,
    /// its standard error, from the spread of the segments' scores
    pub shooting_std: f64,
}

impl Refitted {
    /// Difference in standard errors of the difference, taken as independent.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        (self.shooting - self.weak) / self.weak_std.hypot(self.shooting_std)
    }
}
