//! How large a series may be: held wherever one is read, planned or flown, before anything is made of it.

use super::FourierTrajectory;
use std::ops::RangeInclusive;

/// Shortest and longest period, s.
pub const PERIOD_S: RangeInclusive<f64> = 0.1..=1000.0;
/// Harmonics of a series. The planner's own have at most 20.
pub const HARMONICS_MAX: usize = 64;
/// The longest flight of a series, s: all its periods together. No battery of a multirotor lasts longer.
pub const FLOWN_MAX_S: f64 = 3600.0;

/// A series that is too large, or too short to be one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{what}: expected {expected}, got {got}")]
pub struct SizeError {
    /// what is too large
    pub what: &'static str,
    /// what would do
    pub expected: String,
    /// what came
    pub got: String,
}

/// Whether a series of such a period (s) and so many harmonics may be flown so many times.
///
/// # Errors
/// [`SizeError`] with the first that is out of range.
pub fn check_size(period_s: f64, harmonics: usize, repeats: u32) -> Result<(), SizeError> {
    let refuse = |what, expected, got| Err(SizeError { what, expected, got });
    if !PERIOD_S.contains(&period_s) {
        let expected = format!("{} to {} s", PERIOD_S.start(), PERIOD_S.end());
        return refuse("period_s", expected, format!("{period_s:?} s"));
    }
    if harmonics == 0 || harmonics > HARMONICS_MAX {
        return refuse("harmonics", format!("1 to {HARMONICS_MAX}"), harmonics.to_string());
    }
    let flown_s = f64::from(repeats) * period_s;
    if repeats == 0 || flown_s > FLOWN_MAX_S {
        let expected = format!("at least one, and at most {FLOWN_MAX_S} s of flight");
        return refuse("repeats", expected, format!("{repeats} of {period_s} s, {flown_s:.0} s of flight"));
    }
    Ok(())
}

impl FourierTrajectory {
    /// Whether the series may be flown so many times.
    ///
    /// # Errors
    /// As [`check_size`].
    pub fn check_size(&self, repeats: u32) -> Result<(), SizeError> {
        check_size(self.period_s, self.axes[0].a.len(), repeats)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_named_with_its_bound() {
        assert_eq!(check_size(10.0, 5, 5), Ok(()));
        for (size, words) in [
            ((1e12, 5, 5), "period_s: expected 0.1 to 1000 s, got 1000000000000.0 s"),
            ((f64::NAN, 5, 5), "got NaN s"),
            ((10.0, 0, 5), "harmonics: expected 1 to 64, got 0"),
            ((10.0, 60_000, 5), "got 60000"),
            ((10.0, 5, 0), "repeats: expected at least one"),
            ((10.0, 5, u32::MAX), "4294967295 of 10 s, 42949672950 s of flight"),
        ] {
            let said = check_size(size.0, size.1, size.2).unwrap_err().to_string();
            assert!(said.contains(words), "{said}");
        }
    }
}
