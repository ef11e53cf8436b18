//! The ranges of settings.

use std::time::Duration;

use super::SimulateError;

/// A setting that must be positive and finite.
pub(super) fn positive(name: &'static str, value: f64) -> Result<f64, SimulateError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulateError::Setting { name, expected: "positive and finite", value })
    }
}

/// A setting that must be zero or above, and finite.
pub(super) fn not_negative(name: &'static str, value: f64) -> Result<f64, SimulateError> {
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulateError::Setting { name, expected: "zero or above and finite", value })
    }
}

/// A time (s) as the nearest number of steps (s).
pub(super) fn whole_steps(name: &'static str, time_s: f64, step_s: f64) -> Result<usize, SimulateError> {
    let expected = "at least 0 and step_s at least 1 ns, and their ratio a count that fits";
    let failed = || SimulateError::Setting { name, expected, value: time_s };
    let nanoseconds =
        |seconds| Duration::try_from_secs_f64(seconds).map(|d| d.as_nanos()).map_err(|_| failed());
    let (time, step) = (nanoseconds(time_s)?, nanoseconds(step_s)?);
    let steps = (time + step / 2).checked_div(step).ok_or_else(failed)?;
    usize::try_from(steps).map_err(|_| failed())
}
