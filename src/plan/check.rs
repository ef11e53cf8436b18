//! Any path against any bounds, at equal steps of time.

use super::bounds::{Bound, Dynamics, Instant, Quantity};
use super::space::Path;

/// Between samples of a check, s: the step of the paper's inner loop.
pub const SAMPLE_S: f64 = 0.002;

/// The distance of a path to one side of one bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// what is bounded
    pub quantity: Quantity,
    /// the bound, in the quantity's unit
    pub limit: f64,
    /// true for an upper bound
    pub upper: bool,
    /// the value nearest to the bound or furthest beyond it
    pub value: f64,
    /// time, s from the path's start
    pub time_s: f64,
}

impl Margin {
    /// The distance to the bound, in the quantity's unit; negative if the bound is violated.
    #[must_use]
    pub fn spare(&self) -> f64 {
        if self.upper { self.limit - self.value } else { self.value - self.limit }
    }
}

/// The first violation of a bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Violation {
    /// time, s from the path's start
    pub time_s: f64,
    /// the bounded quantity
    pub quantity: Quantity,
    /// value at this time
    pub value: f64,
    /// the violated bound
    pub limit: f64,
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { time_s, quantity, value, limit } = self;
        let (value, limit) = (quantity.amount(*value), quantity.amount(*limit));
        write!(f, "at {time_s:.3} s {} is {value}, its limit {limit}", quantity.words())
    }
}

/// Result of a check.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckReport {
    /// one for each side of a bound, in the order of the bounds
    pub margins: Vec<Margin>,
    /// the earliest violation
    pub first_violation: Option<Violation>,
}

/// Checks `path` (seconds to x, y, z, psi with four derivatives) from 0 to `duration_s` in steps of [`SAMPLE_S`]. A
/// value that is not a number violates every bound.
#[must_use]
pub fn check(
    path: impl Fn(f64) -> Path,
    duration_s: f64,
    bounds: &[Bound],
    dynamics: &Dynamics,
) -> CheckReport {
    let mut margins: Vec<Margin> = Vec::new();
    for bound in bounds {
        for (limit, upper) in [(bound.max, true), (bound.min, false)] {
            if let Some(limit) = limit {
                let value = if upper { f64::NEG_INFINITY } else { f64::INFINITY };
                margins.push(Margin { quantity: bound.quantity, limit, upper, value, time_s: 0.0 });
            }
        }
    }
    let mut first_violation = None;
    for time_s in sample_times(duration_s) {
        let instant = Instant::new(path(time_s), dynamics);
        for margin in &mut margins {
            let value = instant.value(margin.quantity, dynamics);
            let seen = Margin { value, time_s, ..*margin };
            let broken = seen.spare() < 0.0 || value.is_nan();
            if seen.spare() < margin.spare() || value.is_nan() {
                *margin = seen;
            }
            if broken && first_violation.is_none() {
                first_violation =
                    Some(Violation { time_s, quantity: seen.quantity, value, limit: seen.limit });
            }
        }
    }
    CheckReport { margins, first_violation }
}

/// 0, 2 ms, ... below `duration_s`.
fn sample_times(duration_s: f64) -> impl Iterator<Item = f64> {
    let mut count = 0.0;
    std::iter::from_fn(move || {
        let time_s = count * SAMPLE_S;
        count += 1.0;
        (time_s < duration_s - 0.5 * SAMPLE_S).then_some(time_s)
    })
}
