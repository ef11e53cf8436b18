//! Tests and intervals by blocks of a series, whose neighbouring values are not independent.

use super::chance::f_tail;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Stretches of the series. Fewer leave the test no degrees of freedom against six columns; more are shorter than
/// what correlates in a flight.
pub const STRETCHES: usize = 12;

/// Chance of coefficients `theta` if nothing were there, by an F test with the scores of twelve stretches of the series
/// as replicates. An effect that is there in one part alone passes no such test. `scores` has one row a coefficient and
/// one column an observation; `inverse` is that of the normal matrix.
#[must_use]
pub fn chance_by_stretches(scores: &DMatrix<f64>, inverse: &DMatrix<f64>, theta: &DVector<f64>) -> f64 {
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
    f_tail(f, (size as f64, stretches - size as f64))
}

/// Block bootstrap: `draws` times as many blocks as there are, drawn with replacement. The same seed draws the same.
pub fn resamples(blocks: usize, draws: usize, seed: u64) -> impl Iterator<Item = Vec<usize>> {
    let mut generator = Pcg64Mcg::seed_from_u64(seed);
    (0..draws).map(move |_| (0..blocks).map(|_| generator.random_range(0..blocks)).collect())
}

/// 2.5 and 97.5 percentile of the finite values; `None` where there are none.
#[must_use]
pub fn percentiles_95(mut values: Vec<f64>) -> Option<(f64, f64)> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let (low, high) = (values.len() / 40, values.len().checked_sub(1 + values.len() / 40)?);
    Some((values[low], values[high]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_one_stretch_alone_is_not_certain() {
        // one coefficient, 120 observations: scores of the same sum, throughout and in one stretch
        let inverse = DMatrix::from_element(1, 1, 1.0 / 120.0);
        let theta = DVector::from_element(1, 0.3);
        let chance = |score: &dyn Fn(usize) -> f64| {
            chance_by_stretches(&DMatrix::from_fn(1, 120, |_, column| score(column)), &inverse, &theta)
        };
        let throughout = chance(&|column| if column % 2 == 0 { 1.0 } else { -0.9 });
        let in_one = chance(&|column| if column < 10 { 6.0 } else { 0.0 });
        assert!(throughout < 1e-6 && in_one > 0.05, "{throughout} {in_one}");
    }

    #[test]
    fn resamples_repeat_and_stay_inside() {
        let drawn: Vec<Vec<usize>> = resamples(7, 30, 1).collect();
        assert!(drawn.len() == 30 && drawn.iter().all(|picks| picks.len() == 7));
        assert!(drawn.iter().flatten().all(|pick| *pick < 7));
        assert_eq!(drawn, resamples(7, 30, 1).collect::<Vec<_>>());
        assert!(resamples(0, 2, 1).all(|picks| picks.is_empty()));
    }

    #[test]
    fn percentiles_leave_out_as_many_on_both_sides() {
        let values = (0..200).map(f64::from).chain([f64::NAN]).collect();
        assert_eq!(percentiles_95(values), Some((5.0, 194.0)));
        assert_eq!(percentiles_95(Vec::new()), None);
    }

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
