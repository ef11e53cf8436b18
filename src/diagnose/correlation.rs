//! Variance of scores whose rows are correlated: kernels overlap, and noise lasts.

use super::channels::CHANNELS;
use super::columns::Columns;
use super::evidence::Weighted;
use crate::estimate::SCORE_LAGS;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Number of neighbouring rows whose kernels overlap: the kernel is 0.4 s wide and rows are 0.05 s apart.
pub(super) const OVERLAP: usize = 8;
/// Longest residual correlation that is allowed for, rows (6 s). Longer ones are drift, which a flight of a minute
/// cannot measure.
const MOST_LAGS: usize = 120;

/// Lags whose sums run side by side: one alone waits for every addition.
const SIDE_BY_SIDE: usize = 16;

/// Autocovariance of a series at some lags from `first` on, over runs without a break.
fn autocovariances<const N: usize>(series: &[f64], runs: &[Range<usize>], first: usize) -> [f64; N] {
    let (mut sums, mut counts) = ([0.0; N], [0usize; N]);
    for run in runs {
        let series = &series[run.clone()];
        let pairs = |lag: usize| series.len().saturating_sub(first + lag);
        let all = pairs(N - 1);
        for (value, later) in series.iter().zip(series[first.min(series.len())..].windows(N)) {
            sums.iter_mut().zip(later).for_each(|(sum, later)| *sum += value * later);
        }
        for (lag, (sum, count)) in sums.iter_mut().zip(&mut counts).enumerate() {
            for t in all..pairs(lag) {
                *sum += series[t] * series[t + first + lag];
            }
            *count += pairs(lag);
        }
    }
    std::array::from_fn(|lag| if counts[lag] == 0 { 0.0 } else { sums[lag] / counts[lag] as f64 })
}

impl Weighted {
    /// Autocovariance of each channel up to the lag at which it has decayed, at least the kernels' overlap. Noise of an
    /// estimator or of a poor accelerometer is correlated for seconds.
    pub(super) fn gammas(&self, residual: &DVector<f64>) -> Vec<Vec<f64>> {
        (0..CHANNELS).into_par_iter().map(|channel| self.gamma(residual, channel)).collect()
    }

    /// Autocovariance of one channel.
    pub(super) fn gamma(&self, residual: &DVector<f64>, channel: usize) -> Vec<f64> {
        let series = &residual.as_slice()[channel * self.rows..(channel + 1) * self.rows];
        let [zero] = autocovariances(series, &self.measured[channel], 0);
        let mut gamma = vec![zero];
        for first in (1..MOST_LAGS).step_by(SIDE_BY_SIDE) {
            let some: [f64; SIDE_BY_SIDE] = autocovariances(series, &self.measured[channel], first);
            for (lag, at) in (first..MOST_LAGS).zip(some) {
                gamma.push(at);
                if lag >= OVERLAP && at < 0.05 * zero {
                    return gamma;
                }
            }
        }
        gamma
    }

    /// `sum_c sum_|l|<=L gamma_c(l) sum_t x_c(t) x_c(t+l)'`.
    pub(super) fn meat_of_residual(&self, columns: &Columns, gammas: &[Vec<f64>]) -> DMatrix<f64> {
        columns.correlated(gammas, &self.measured)
    }

    /// Covariance of coefficients whose normal matrix has the inverse `bread`, from the residual that they leave: by its
    /// autocovariance, with standard errors by the scores where those are larger. `prior` is the part of what was known before
    /// in the variance of the scores.
    pub(super) fn sandwich(
        &self,
        bread: &DMatrix<f64>,
        columns: &Columns,
        left: &DVector<f64>,
        prior: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let gammas = self.gammas(left);
        let by_residual = bread * (self.meat_of_residual(columns, &gammas) + prior) * bread;
        let scores = columns.scores(left.as_slice());
        let by_score = bread * (self.meat_of_scores(&scores, &gammas) + prior) * bread;
        let more = |k: usize| (by_score[(k, k)] / by_residual[(k, k)]).max(1.0).sqrt();
        DMatrix::from_fn(bread.nrows(), bread.ncols(), |i, j| {
            if by_residual[(i, i)] > 0.0 && by_residual[(j, j)] > 0.0 {
                by_residual[(i, j)] * more(i) * more(j)
            } else {
                by_score[(i, j)]
            }
        })
    }

    /// Variance of the summed scores (Newey-West): a Bartlett window over their lags.
    pub(super) fn meat_of_scores(&self, scores: &Columns, gammas: &[Vec<f64>]) -> DMatrix<f64> {
        let window = gammas.iter().map(Vec::len).max().unwrap_or(0).max(SCORE_LAGS);
        scores.correlated_by_bartlett(window, &self.runs)
    }
}
