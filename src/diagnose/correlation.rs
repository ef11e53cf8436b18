//! Variance of scores whose rows are correlated: kernels overlap, and noise lasts.

use super::channels::CHANNELS;
use super::columns::Columns;
use super::evidence::Weighted;
use nalgebra::{DMatrix, DVector};

/// Number of neighbouring rows whose kernels overlap: the kernel is 0.4 s wide and rows are 0.05 s apart.
const OVERLAP: usize = 8;
/// Longest residual correlation that is allowed for, rows (6 s). Chosen; not measured.
const MOST_LAGS: usize = 120;
/// Least width of the Bartlett window of the scores, rows (1 s). Chosen; not measured.
const SCORE_LAGS: usize = 20;

impl Weighted {
    /// Autocovariance of each channel up to the lag at which it has decayed, at least the kernels' overlap. Noise of an
    /// estimator or of a poor accelerometer is correlated for seconds.
    pub(super) fn gammas(&self, residual: &DVector<f64>) -> Vec<Vec<f64>> {
        (0..CHANNELS)
            .map(|channel| {
                let zero = self.autocovariance(residual, channel, 0);
                let mut gamma = vec![zero];
                for lag in 1..MOST_LAGS {
                    let at = self.autocovariance(residual, channel, lag);
                    gamma.push(at);
                    if lag >= OVERLAP && at < 0.05 * zero {
                        break;
                    }
                }
                gamma
            })
            .collect()
    }

    fn autocovariance(&self, residual: &DVector<f64>, channel: usize, lag: usize) -> f64 {
        let series = residual.rows(channel * self.rows, self.rows);
        let (mut sum, mut count) = (0.0, 0usize);
        for run in &self.measured[channel] {
            for t in run.start..run.end.saturating_sub(lag) {
                sum += series[t] * series[t + lag];
                count += 1;
            }
        }
        if count == 0 { 0.0 } else { sum / count as f64 }
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
        let bartlett = (0..=window).map(|lag| 1.0 - lag as f64 / (window as f64 + 1.0)).collect();
        scores.correlated(&[bartlett], std::slice::from_ref(&self.runs))
    }
}
