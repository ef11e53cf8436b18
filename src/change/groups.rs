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

    /// A factor on what was before, and the standard error of its logarithm: the way back has the inverse factor, as many standard errors
    /// from 1.
    #[must_use]
    pub fn factor(value: f64, std_of_log: f64) -> Self {
        let log = value.ln();
        let slope = (value - 1.0) / log;
        let std = std_of_log * if slope.is_finite() { slope } else { 1.0 };
        Self { before: (1.0, 0.0), after: (value, std), by: (value - 1.0, std) }
    }

    /// The difference in standard errors.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        self.by.0 / self.by.1.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_and_its_inverse_are_as_many_standard_errors_from_1() {
        let [there, back] = [0.8, 1.25].map(|value| Moved::factor(value, 0.02));
        assert!(
            (there.sigmas() + back.sigmas()).abs() < 1e-9 && there.sigmas() < -11.0,
            "{there:?} {back:?}"
        );
        assert!((there.sigmas() - 0.8_f64.ln() / 0.02).abs() < 1e-9);
        assert_eq!(Moved::factor(1.0, 0.02).by, (0.0, 0.02));
    }
}
