//! Variance of scores whose rows are correlated: kernels overlap, and noise lasts.

use super::channels::CHANNELS;
use super::evidence::Weighted;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

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
    pub(super) fn meat_of_residual(&self, columns: &DMatrix<f64>, gammas: &[Vec<f64>]) -> DMatrix<f64> {
        let smear = |index: usize| {
            let (column, mut out) = (columns.column(index), DVector::zeros(columns.nrows()));
            for (channel, gamma) in gammas.iter().enumerate() {
                let lags = gamma.len() - 1;
                let offset = channel * self.rows;
                for run in &self.measured[channel] {
                    for t in run.clone() {
                        let first = t.saturating_sub(lags).max(run.start);
                        let last = (t + lags).min(run.end - 1);
                        let sum: f64 =
                            (first..=last).map(|s| gamma[s.abs_diff(t)] * column[offset + s]).sum();
                        out[offset + t] = sum;
                    }
                }
            }
            columns.tr_mul(&out)
        };
        let parts: Vec<DVector<f64>> = (0..columns.ncols()).into_par_iter().map(smear).collect();
        let meat = DMatrix::from_columns(&parts);
        0.5 * (&meat + meat.transpose())
    }

    /// Score of each row, summed over the channels.
    pub(super) fn scores(&self, columns: &DMatrix<f64>, residual: &DVector<f64>) -> DMatrix<f64> {
        let mut scores = DMatrix::<f64>::zeros(columns.ncols(), self.rows);
        for channel in 0..CHANNELS {
            let offset = channel * self.rows;
            for (index, column) in columns.column_iter().enumerate() {
                for row in 0..self.rows {
                    scores[(index, row)] += column[offset + row] * residual[offset + row];
                }
            }
        }
        scores
    }

    pub(super) fn meat_of_scores(
        &self,
        columns: &DMatrix<f64>,
        residual: &DVector<f64>,
        gammas: &[Vec<f64>],
    ) -> DMatrix<f64> {
        let window = gammas.iter().map(Vec::len).max().unwrap_or(0).max(SCORE_LAGS);
        let scores = self.scores(columns, residual);
        let size = columns.ncols();
        let mut meat = DMatrix::<f64>::zeros(size, size);
        for run in &self.runs {
            for lag in 0..=window {
                let length = run.len().saturating_sub(lag);
                if length == 0 {
                    continue;
                }
                let product: DMatrix<f64> =
                    scores.columns(run.start, length) * scores.columns(run.start + lag, length).transpose();
                let bartlett = 1.0 - lag as f64 / (window as f64 + 1.0);
                if lag == 0 {
                    meat += product;
                } else {
                    meat += bartlett * (&product + product.transpose());
                }
            }
        }
        meat
    }
}
