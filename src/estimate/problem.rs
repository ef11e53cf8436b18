//! Weighted least squares over several channels, with standard errors for coloured residuals.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// One equation, repeated over time: `y = X theta + e`.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// output, one entry a row
    pub y: DVector<f64>,
    /// rows x parameters
    pub x: DMatrix<f64>,
}

/// Channels that share their parameters and their rows' instants.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// one for each measured equation
    pub channels: Vec<Channel>,
    /// rows without a break in time
    pub runs: Vec<Range<usize>>,
    /// parameters with a prior of mean zero, and its standard deviation
    pub priors: Vec<(usize, f64)>,
    /// lags (rows) over which white noise is correlated by the kernels' overlap
    pub overlap: usize,
}

/// A solution with its residuals and diagnostics.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// estimates; NaN for parameters without data (a zero column)
    pub theta: DVector<f64>,
    /// covariance that allows for coloured residuals
    pub covariance: DMatrix<f64>,
    /// per channel: residuals
    pub residuals: Vec<DVector<f64>>,
    /// per channel: residual standard deviation
    pub sigma: Vec<f64>,
    /// condition number of the regressor with its columns scaled to unit length
    pub scaled_condition: f64,
    /// lags used for the residuals' autocovariance
    pub lags: usize,
}

/// Longest correlation of the residuals that is allowed for, rows (2 s). Longer ones are drift, which no flight of a
/// minute can measure; coverage: `cargo bench --bench coverage`.
const MOST_LAGS: usize = 40;
/// Width of the Bartlett window of the scores, rows (1 s). It covers the kernel's 0.4 s and the controller's
/// response; the coverage of the intervals is measured by `cargo bench --bench coverage`.
pub const SCORE_LAGS: usize = 20;

impl Problem {
    /// Number of parameters.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.channels.first().map_or(0, |channel| channel.x.ncols())
    }

    /// Least squares with each channel weighted by its own residual.
    #[must_use]
    pub fn solve(&self) -> Solution {
        let Fit { mut theta, sigma, normal } = self.fit();
        let residuals = self.residuals(&theta);
        let lags = self.residual_lags(&residuals);
        let bread = normal.inverse();
        let covariance = self.covariance(&bread, &Scaled { residuals: &residuals, sigma: &sigma, lags });
        for (index, value) in theta.iter_mut().enumerate() {
            if normal.scale[index] <= 0.0 {
                *value = f64::NAN;
            }
        }
        Solution { theta, covariance, residuals, sigma, scaled_condition: normal.condition(), lags }
    }

    /// The estimate alone; parameters without a column are zero.
    #[must_use]
    pub fn estimate(&self) -> DVector<f64> {
        self.fit().theta
    }

    /// Alternates between the parameters and the channels' weights.
    fn fit(&self) -> Fit {
        let size: Vec<f64> = self.channels.iter().map(|c| spread(&c.y).max(1e-100)).collect();
        let mut sigma = size.clone();
        // each channel's share of the normal equations stays; only its weight changes
        let shares: Vec<Normal> =
            (0..self.channels.len()).map(|channel| self.normal_share(channel)).collect();
        let mut fit = Fit { theta: DVector::zeros(0), sigma: Vec::new(), normal: Normal::empty(0) };
        for _ in 0..4 {
            let normal = Normal::weighted(&shares, &sigma, &self.priors);
            let theta = normal.solve();
            for ((sigma, size), residual) in sigma.iter_mut().zip(&size).zip(self.residuals(&theta)) {
                // an exact fit leaves only rounding, which is no measure of weight
                *sigma = spread(&residual).max(1e-12 * size);
            }
            fit = Fit { theta, sigma: sigma.clone(), normal };
        }
        fit
    }

    /// Residuals of every channel; NaN parameters (zero columns) count as zero.
    #[must_use]
    pub fn residuals(&self, theta: &DVector<f64>) -> Vec<DVector<f64>> {
        let theta = theta.map(|value| if value.is_finite() { value } else { 0.0 });
        self.channels.iter().map(|channel| &channel.y - &channel.x * &theta).collect()
    }

    pub(super) fn normal_share(&self, index: usize) -> Normal {
        let Channel { x, y } = &self.channels[index];
        Normal { matrix: x.tr_mul(x), right: x.tr_mul(y), ..Normal::empty(self.parameters()) }
    }

    /// First lag at which the residual autocorrelation of every channel has decayed, at least the kernels' overlap.
    fn residual_lags(&self, residuals: &[DVector<f64>]) -> usize {
        let died = |lag: usize| {
            residuals.iter().all(|r| {
                let zero = self.autocovariance(r, 0);
                zero <= 0.0 || self.autocovariance(r, lag).abs() < 0.05 * zero
            })
        };
        (self.overlap..MOST_LAGS).find(|&lag| died(lag)).unwrap_or(MOST_LAGS)
    }

    fn autocovariance(&self, series: &DVector<f64>, lag: usize) -> f64 {
        let mut sum = 0.0;
        let mut count: usize = 0;
        for run in &self.runs {
            for t in run.start..run.end.saturating_sub(lag) {
                sum += series[t] * series[t + lag];
                count += 1;
            }
        }
        if count == 0 { 0.0 } else { sum / count as f64 }
    }

    /// The larger of two sandwich covariances for each parameter: with the channels' own residual autocovariances, and
    /// Newey-West on the scores. `bread` is the inverse of the normal matrix.
    fn covariance(&self, bread: &DMatrix<f64>, scaled: &Scaled<'_>) -> DMatrix<f64> {
        let mut prior = DMatrix::<f64>::zeros(self.parameters(), self.parameters());
        for &(parameter, deviation) in &self.priors {
            prior[(parameter, parameter)] = deviation.powi(-2);
        }
        let freedom = self.freedom();
        let sandwich = |meat: DMatrix<f64>| bread * (meat * freedom + &prior) * bread.transpose();
        let by_residual = sandwich(self.meat_of_residuals(scaled));
        let by_score = sandwich(self.meat_of_scores(scaled));
        // the autocovariances are not tapered: a variance may come out negative, and then says nothing
        if (0..self.parameters()).any(|i| by_residual[(i, i)] < 0.0) {
            return by_score;
        }
        let inflation = DVector::from_fn(self.parameters(), |i, _| {
            let ratio = by_score[(i, i)] / by_residual[(i, i)];
            if ratio > 1.0 { ratio.sqrt() } else { 1.0 }
        });
        DMatrix::from_fn(self.parameters(), self.parameters(), |i, j| {
            by_residual[(i, j)] * inflation[i] * inflation[j]
        })
    }

    /// Factor for the degrees of freedom, because residuals of a fit are smaller than the noise: each parameter of an
    /// equation costs one independent row, and independent rows are an overlap apart.
    fn freedom(&self) -> f64 {
        let rows = self.runs.iter().map(Range::len).sum::<usize>() as f64;
        let most = self
            .channels
            .iter()
            .map(|channel| channel.x.column_iter().filter(|column| column.norm_squared() > 0.0).count())
            .max()
            .unwrap_or(0) as f64;
        let spent = (most * self.overlap as f64).min(0.5 * rows);
        rows / (rows - spent)
    }

    fn meat_of_residuals(&self, scaled: &Scaled<'_>) -> DMatrix<f64> {
        let mut meat = DMatrix::zeros(self.parameters(), self.parameters());
        for (index, channel) in self.channels.iter().enumerate() {
            let gamma: Vec<f64> = (0..=scaled.lags)
                .map(|lag| self.autocovariance(&scaled.residuals[index], lag) / scaled.sigma[index].powi(4))
                .collect();
            meat += self.meat_of(&channel.x, &gamma);
        }
        meat
    }

    /// One channel's `sum_|l|<=L gamma(l) sum_t x(t) x(t+l)^T`, as `X^T (gamma * X)`.
    pub(super) fn meat_of(&self, x: &DMatrix<f64>, gamma: &[f64]) -> DMatrix<f64> {
        let lags = gamma.len().saturating_sub(1);
        let smeared = |column: &[f64]| {
            let mut out = vec![0.0; column.len()];
            for run in &self.runs {
                for t in run.clone() {
                    let first = t.saturating_sub(lags).max(run.start);
                    let last = (t + lags).min(run.end - 1);
                    out[t] = (first..=last).map(|s| gamma[s.abs_diff(t)] * column[s]).sum();
                }
            }
            out
        };
        let each: Vec<Vec<f64>> = x.as_slice().par_chunks_exact(x.nrows().max(1)).map(smeared).collect();
        x.tr_mul(&DMatrix::from_vec(x.nrows(), x.ncols(), each.concat()))
    }

    fn meat_of_scores(&self, scaled: &Scaled<'_>) -> DMatrix<f64> {
        let parameters = self.parameters();
        let count = self.runs.last().map_or(0, |run| run.end);
        let mut score = DMatrix::<f64>::zeros(parameters, count);
        for (index, channel) in self.channels.iter().enumerate() {
            let x = &channel.x;
            let weight = scaled.sigma[index].powi(-2);
            for row in 0..count {
                let factor = weight * scaled.residuals[index][row];
                for parameter in 0..parameters {
                    score[(parameter, row)] += factor * x[(row, parameter)];
                }
            }
        }
        let mut meat = DMatrix::<f64>::zeros(parameters, parameters);
        for lag in 0..=SCORE_LAGS {
            let bartlett = 1.0 - lag as f64 / (SCORE_LAGS as f64 + 1.0);
            for run in &self.runs {
                let length = run.end.saturating_sub(run.start + lag);
                if length == 0 {
                    continue;
                }
                let product: DMatrix<f64> =
                    score.columns(run.start, length) * score.columns(run.start + lag, length).transpose();
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

/// Residuals with their scale and their autocovariance.
struct Scaled<'a> {
    residuals: &'a [DVector<f64>],
    sigma: &'a [f64],
    lags: usize,
}

/// Normal equations with their columns scaled to unit diagonal.
pub(super) struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    /// square root of the diagonal; 0 where a column is empty
    scale: DVector<f64>,
}

/// Result of the alternation.
struct Fit {
    theta: DVector<f64>,
    sigma: Vec<f64>,
    normal: Normal,
}

impl Normal {
    pub(super) fn weighted(shares: &[Self], sigma: &[f64], priors: &[(usize, f64)]) -> Self {
        let mut sum = Self::empty(shares.first().map_or(0, |share| share.right.len()));
        for (share, sigma) in shares.iter().zip(sigma) {
            let weight = 1.0 / (sigma * sigma);
            sum.matrix += &share.matrix * weight;
            sum.right += &share.right * weight;
        }
        for &(parameter, deviation) in priors {
            sum.matrix[(parameter, parameter)] += deviation.powi(-2);
        }
        sum.finish()
    }

    fn empty(parameters: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(parameters, parameters),
            right: DVector::zeros(parameters),
            scale: DVector::zeros(parameters),
        }
    }

    fn finish(mut self) -> Self {
        self.scale = DVector::from_fn(self.right.len(), |i, _| self.matrix[(i, i)].abs().sqrt());
        self
    }

    fn unit(&self, index: usize) -> f64 {
        if self.scale[index] > 0.0 { 1.0 / self.scale[index] } else { 0.0 }
    }

    /// Inverse of the normal matrix; rows and columns of empty parameters are zero.
    pub(super) fn inverse(&self) -> DMatrix<f64> {
        let n = self.right.len();
        let scaled = DMatrix::from_fn(n, n, |i, j| {
            if self.scale[i] > 0.0 && self.scale[j] > 0.0 {
                self.matrix[(i, j)] * self.unit(i) * self.unit(j)
            } else {
                f64::from(u8::from(i == j))
            }
        });
        let inverse = scaled
            .clone()
            .try_inverse()
            .unwrap_or_else(|| scaled.pseudo_inverse(1e-12).unwrap_or_else(|_| DMatrix::zeros(n, n)));
        DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * self.unit(i) * self.unit(j))
    }

    fn solve(&self) -> DVector<f64> {
        self.inverse() * &self.right
    }

    /// Condition number of the column-scaled regressor: root of the scaled normal matrix' own.
    fn condition(&self) -> f64 {
        let used: Vec<usize> = (0..self.right.len()).filter(|&i| self.scale[i] > 0.0).collect();
        let scaled = DMatrix::from_fn(used.len(), used.len(), |i, j| {
            self.matrix[(used[i], used[j])] * self.unit(used[i]) * self.unit(used[j])
        });
        let singular = scaled.singular_values();
        (singular.max() / singular.min().max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// Root mean square about zero.
fn spread(series: &DVector<f64>) -> f64 {
    if series.is_empty() { 0.0 } else { (series.norm_squared() / series.len() as f64).sqrt() }
}

#[cfg(test)]
#[path = "problem_tests.rs"]
mod tests;
