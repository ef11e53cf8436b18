//! Whether an effect is there throughout the flight, not in one part of it alone.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Stretches of the flight.
const STRETCHES: usize = 12;

/// Chance of coefficients `theta` if nothing were there, by an F test with the scores of twelve stretches of the flight
/// as replicates. `scores` has one row a coefficient and one column a row of the weak form; `inverse` is that of the
/// normal matrix.
pub(super) fn chance_by_stretches(
    scores: &DMatrix<f64>,
    inverse: &DMatrix<f64>,
    theta: &DVector<f64>,
) -> f64 {
    let (size, rows) = scores.shape();
    let mut meat = DMatrix::<f64>::zeros(size, size);
    for stretch in 0..STRETCHES {
        let (from, to) = (rows * stretch / STRETCHES, rows * (stretch + 1) / STRETCHES);
        let sum = scores.columns(from, to - from).column_sum();
        meat += &sum * sum.transpose();
    }
    let stretches = STRETCHES as f64;
    let covariance = inverse * meat * inverse * (stretches / (stretches - 1.0));
    let Some(factor) = covariance.cholesky() else { return 1.0 };
    let f = theta.dot(&factor.solve(theta)) / size as f64 * (stretches - size as f64) / (stretches - 1.0);
    FisherSnedecor::new(size as f64, stretches - size as f64).map_or(1.0, |law| law.sf(f))
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; STRETCHES] = [2.1, -0.4, 1.3, 0.9, 3.2, -1.1, 0.6, 1.8, 2.4, 0.2, -0.7, 1.5];
    const Y: [f64; STRETCHES] = [0.3, 1.2, -0.8, 0.5, -1.4, 2.0, 0.1, -0.6, 0.9, 1.1, -0.2, 0.7];

    /// The mean of each series as a regression on ones, whose stretches have two rows each.
    fn chance_of_means(series: &[&[f64; STRETCHES]]) -> f64 {
        let size = series.len();
        let means = DVector::from_fn(size, |i, _| series[i].iter().sum::<f64>() / STRETCHES as f64);
        // only the stretches' sums count
        let share = |row: usize| if row.is_multiple_of(2) { 0.3 } else { 0.7 };
        let scores =
            DMatrix::from_fn(size, 2 * STRETCHES, |i, row| share(row) * (series[i][row / 2] - means[i]));
        chance_by_stretches(&scores, &(DMatrix::identity(size, size) / STRETCHES as f64), &means)
    }

    /// SciPy: `scipy.stats.ttest_1samp(x, 0).pvalue`
    #[test]
    fn one_mean_has_the_chance_of_students_test() {
        assert!((chance_of_means(&[&X]) / 0.025_228_005_916_505_58 - 1.0).abs() < 1e-9);
    }

    /// NumPy and SciPy, Hotelling's test, with X of 12 rows `x, y` and m their mean:
    /// `scipy.stats.f.sf(12 * m @ numpy.linalg.solve(numpy.cov(X.T), m) * 10 / 22, 2, 10)`
    #[test]
    fn two_means_have_the_chance_of_hotellings_test() {
        assert!((chance_of_means(&[&X, &Y]) / 0.007_824_845_223_614_43 - 1.0).abs() < 1e-9);
    }
}
