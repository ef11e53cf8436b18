//! Medians and what is measured by them.

/// A normal variable's standard deviation over the median of its size, `1 / Phi^-1(3/4)`.
const SIGMA_OF_MEDIAN: f64 = 1.4826;

/// Standard deviation of the white part of an evenly sampled series: 1.4826 MAD of the fourth difference over
/// `sqrt(70)`. A smooth signal hardly moves a fourth difference, and the median makes lost samples
/// harmless. NaN with fewer than five samples.
#[must_use]
pub fn white_level_of(series: &[f64]) -> f64 {
    let mut differences: Vec<f64> = series
        .windows(5)
        .map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs())
        .filter(|d| d.is_finite())
        .collect();
    normal_sigma(&mut differences) / 70.0_f64.sqrt()
}

/// Standard deviation of normal errors by the median of their `sizes`, which are reordered: a few gross errors do not
/// count. NaN where there are none.
#[must_use]
pub fn normal_sigma(sizes: &mut [f64]) -> f64 {
    SIGMA_OF_MEDIAN * median(sizes)
}

/// Median, reordering the values; NaN where there are none.
#[must_use]
pub fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Median step from one value to the next; NaN for fewer than two.
#[must_use]
pub fn median_step(values: &[f64]) -> f64 {
    let mut steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    median(&mut steps)
}

/// The value below which `part` of `whole` of the others lie, in order already; `None` where there are none.
#[must_use]
pub fn quantile(ordered: &[f64], (part, whole): (usize, usize)) -> Option<f64> {
    ordered.get(ordered.len().saturating_sub(1) * part / whole).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_quantiles_of_few_values() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert!(median(&mut []).is_nan() && median_step(&[1.0]).is_nan());
        assert_eq!(median_step(&[0.0, 1.0, 2.0, 7.0]), 1.0);
        let ordered: Vec<f64> = (0..101).map(f64::from).collect();
        assert_eq!(quantile(&ordered, (2, 100)), Some(2.0));
        assert_eq!(quantile(&ordered, (1, 1)), Some(100.0));
        assert_eq!(quantile(&[], (1, 2)), None);
    }
}
