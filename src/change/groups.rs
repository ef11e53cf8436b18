//! Two groups of flights, and a value in each.

/// Flights before and after, by their places. None is in both, and neither is empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Groups {
    /// earlier
    pub before: Vec<usize>,
    /// later
    pub after: Vec<usize>,
}

impl Groups {
    /// All flights of a row in two parts: the later one begins at `from`.
    #[must_use]
    pub fn split(flights: usize, from: usize) -> Self {
        Self { before: (0..from).collect(), after: (from..flights).collect() }
    }

    /// The groups in order.
    pub(super) fn both(&self) -> [&[usize]; 2] {
        [&self.before, &self.after]
    }

    /// How many flights of a group are there beside one, of both.
    pub(super) fn beside_one(&self) -> usize {
        (self.before.len() + self.after.len()).saturating_sub(2)
    }
}

/// Standard errors on each side of a normal value's interval of 95 %.
const COVERING: f64 = 1.96;

/// The interval of 95 % of a value with its standard error.
#[must_use]
pub fn interval_95((value, std): (f64, f64)) -> [f64; 2] {
    [-COVERING, COVERING].map(|by| value + by * std)
}

/// A value before and after, and the difference, each with its standard error; one unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// value and standard error before
    pub before: (f64, f64),
    /// the same after
    pub after: (f64, f64),
    /// after less before
    pub by: (f64, f64),
}

impl Moved {
    /// In another unit.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let of = |(value, std): (f64, f64)| (factor * value, factor.abs() * std);
        Self { before: of(self.before), after: of(self.after), by: of(self.by) }
    }

    /// The difference in standard errors.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        self.by.0 / self.by.1.max(f64::MIN_POSITIVE)
    }
}
