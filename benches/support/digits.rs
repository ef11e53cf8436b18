//! Rounding of figures that are stored.

/// A number to four significant digits.
pub fn short(value: f64) -> f64 {
    to_digits(value, 4)
}

/// A number to this many significant digits.
pub fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// The value at this share of the sorted values; `None` if there are none.
pub fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in the list")]
    let place = (values.len() as f64 * share) as usize;
    values.get(place).copied()
}
