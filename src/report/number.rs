//! Display of intervals.

use crate::diagnose::holdout::Interval;
use crate::text::rounded;

pub use crate::text::{chance, interval, significant, spoken, with_error};

/// `49 % (44 to 53 %)`.
#[must_use]
pub fn percent(of: &Interval) -> String {
    // a model that left the flight has no error to compare
    if !of.value.is_finite() {
        return "-".to_owned();
    }
    let whole = |value: f64| rounded(value, 0);
    let range = of.range.map(|(low, high)| format!(" ({} to {} %)", whole(low), whole(high)));
    format!("{} %{}", whole(of.value), range.unwrap_or_default())
}
