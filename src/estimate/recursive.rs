//! The paper's estimators over time: least squares (40) and gradient descent (41), (42).

use super::theta::{THETA, Theta, ThetaCovariance, scale_of};
use crate::regression::SampledModel;
use nalgebra::{Matrix4, SMatrix, Vector4};

/// The paper's adaptation gain sigma of (41).
pub const PAPER_SIGMA: f64 = 30.0;
/// Time between the entries of a history, s.
const HISTORY_STEP_S: f64 = 0.2;
/// Length of the blocks over which scores are summed, s. A tenth of the correlation that is allowed for; only memory
/// depends on it.
pub(super) const SCORE_BLOCK_S: f64 = 0.1;
/// Number of blocks over which scores are correlated (1 s). As in the weak form: the controller's response; coverage:
/// `cargo bench --bench coverage`.
pub(super) const LAGS: usize = 10;

/// Estimates over time.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// s, vehicle clock
    pub time_s: Vec<f64>,
    /// estimate at each of these times (the paper's figures 4 and 5)
    pub theta: Vec<Theta>,
}

/// Result of one of the paper's four methods.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperEstimate {
    /// `[m Ixx Ixy Ixz Iyy Iyz Izz]`
    pub theta: Theta,
    /// allows for coloured residuals
    pub covariance: ThetaCovariance,
    /// estimates over time
    pub history: History,
}

/// Recursive least squares (40): the information sums grow sample by sample and the last estimate is
/// the batch one. `None` where the information matrix never becomes regular.
#[must_use]
pub fn least_squares(model: &SampledModel) -> Option<PaperEstimate> {
    let mut sums = NormalEquations::default();
    let mut history = History { time_s: Vec::new(), theta: Vec::new() };
    let mut next_s = f64::NEG_INFINITY;
    for ((gamma, upsilon), &time_s) in model.gamma.iter().zip(&model.upsilon).zip(&model.time_s) {
        sums.add(&gamma.matrix(), upsilon);
        if time_s >= next_s {
            next_s = time_s + HISTORY_STEP_S;
            if let Some(theta) = sums.solve() {
                history.time_s.push(time_s);
                history.theta.push(theta);
            }
        }
    }
    let theta = sums.solve()?;
    let inverse = sums.information.try_inverse()?;
    let covariance = sandwich(model, &theta, &inverse);
    Some(PaperEstimate { theta, covariance, history })
}

/// The sums of (40): `Gamma^T Gamma` and `Gamma^T Upsilon` over the samples so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NormalEquations {
    pub(super) information: ThetaCovariance,
    pub(super) right: Theta,
}

impl Default for NormalEquations {
    fn default() -> Self {
        Self { information: ThetaCovariance::zeros(), right: Theta::zeros() }
    }
}

impl NormalEquations {
    /// Adds a sample.
    pub(super) fn add(&mut self, gamma: &SMatrix<f64, 4, THETA>, upsilon: &Vector4<f64>) {
        self.information += gamma.tr_mul(gamma);
        self.right += gamma.tr_mul(upsilon);
    }

    /// Adds the sums of other samples.
    pub(super) fn merge(&mut self, other: &Self) {
        self.information += other.information;
        self.right += other.right;
    }

    /// Their solution with scaled columns; `None` while they are singular.
    pub(super) fn solve(&self) -> Option<Theta> {
        let Self { information, right } = self;
        let scale = Theta::from_fn(|i, _| information[(i, i)].sqrt());
        if scale.iter().any(|s| s.is_nan() || *s <= 0.0) {
            return None;
        }
        let scaled = ThetaCovariance::from_fn(|i, j| information[(i, j)] / (scale[i] * scale[j]));
        let solution = scaled.cholesky()?.solve(&right.component_div(&scale));
        Some(solution.component_div(&scale))
    }
}

/// Variance of a sum of scores that are correlated over up to `lags` of them, with Bartlett's weights.
pub(super) fn newey_west(scores: &[Theta], lags: usize) -> ThetaCovariance {
    let mut meat = ThetaCovariance::zeros();
    for lag in 0..=lags.min(scores.len().saturating_sub(1)) {
        let bartlett = 1.0 - lag as f64 / (lags as f64 + 1.0);
        for (late, early) in scores[lag..].iter().zip(scores) {
            let product = early * late.transpose();
            meat += if lag == 0 { product } else { bartlett * (product + product.transpose()) };
        }
    }
    meat
}

/// Newey-West covariance of (40) over a second of score correlation.
fn sandwich(model: &SampledModel, theta: &Theta, inverse: &SMatrix<f64, THETA, THETA>) -> ThetaCovariance {
    // scores summed over 0.1 s blocks: their lags then reach far at little cost
    let mut block = 1;
    while (block as f64) * model.step_s < SCORE_BLOCK_S {
        block += 1;
    }
    let mut meat = ThetaCovariance::zeros();
    for run in &model.runs {
        let scores: Vec<Theta> = (run.start..run.end)
            .step_by(block)
            .map(|start| {
                (start..(start + block).min(run.end))
                    .map(|i| {
                        let gamma = model.gamma[i].matrix();
                        gamma.tr_mul(&(model.upsilon[i] - gamma * theta))
                    })
                    .sum()
            })
            .collect();
        meat += newey_west(&scores, LAGS);
    }
    inverse * meat * inverse.transpose()
}

/// Gradient descent (41), (42) from `start` (the nominal parameters), with the implicit step
/// `(I + sigma T Gamma^T Gamma) theta_h = theta_(h-1) + sigma T Gamma^T Upsilon`: it is stable for every sigma, and the
/// explicit one diverges once `sigma T |Gamma|^2 > 2`.
///
/// The covariance follows the same linear recursion, from a start that is uncertain by its own size,
/// driven by the residual with its long-run variance.
#[must_use]
pub fn gradient_descent(model: &SampledModel, start: &Theta, sigma: f64) -> PaperEstimate {
    let gain = sigma * model.step_s;
    let mut theta = *start;
    let mut history = History { time_s: Vec::new(), theta: Vec::new() };
    let mut next_s = f64::NEG_INFINITY;
    for ((gamma, upsilon), &time_s) in model.gamma.iter().zip(&model.upsilon).zip(&model.time_s) {
        let gamma = &gamma.matrix();
        theta += gain_matrix(gamma, gain) * (upsilon - gamma * theta);
        if time_s >= next_s {
            next_s = time_s + HISTORY_STEP_S;
            history.time_s.push(time_s);
            history.theta.push(theta);
        }
    }
    let noise = long_run_variance(model, &theta);
    // the start is a guess as wrong as it is large: what the descent does not forget of it stays uncertain
    let guess = Theta::from_fn(|i, _| scale_of(start, i).powi(2));
    let mut covariance = ThetaCovariance::from_diagonal(&guess);
    for gamma in &model.gamma {
        let gamma = &gamma.matrix();
        let k = gain_matrix(gamma, gain);
        let transition = ThetaCovariance::identity() - k * gamma;
        covariance = transition * covariance * transition.transpose() + k * noise * k.transpose();
    }
    PaperEstimate { theta, covariance, history }
}

/// The 7 x 4 gain on the innovation `Upsilon - Gamma theta_(h-1)`:
/// `(I + c Gamma^T Gamma)^-1 c Gamma^T = c Gamma^T (I + c Gamma Gamma^T)^-1`, a 4 x 4 inverse.
fn gain_matrix(gamma: &SMatrix<f64, 4, THETA>, gain: f64) -> SMatrix<f64, THETA, 4> {
    let explicit = gamma.transpose() * gain;
    let inner = Matrix4::identity() + gain * gamma * gamma.transpose();
    inner.cholesky().map_or(explicit, |factor| explicit * factor.inverse())
}

/// Residual variance per sample as a slow filter sees it: the sum of autocovariances over 0.5 s.
fn long_run_variance(model: &SampledModel, theta: &Theta) -> Matrix4<f64> {
    let mut block = 1;
    while (block as f64) * model.step_s < 0.5 {
        block += 1;
    }
    let mut sum = Vector4::zeros();
    let mut count = 0_u32;
    for run in &model.runs {
        let residuals: Vec<Vector4<f64>> =
            run.clone().map(|i| model.upsilon[i] - model.gamma[i].matrix() * theta).collect();
        for chunk in residuals.chunks_exact(block) {
            let total: Vector4<f64> = chunk.iter().sum();
            sum += total.component_mul(&total) / block as f64;
            count += 1;
        }
    }
    Matrix4::from_diagonal(&(sum / f64::from(count.max(1))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SVector, Vector3};

    fn model(step_s: f64) -> (SampledModel, Theta) {
        let truth = SVector::from([1.82, 0.0075, -0.0005, 0.0, 0.0098, -0.001, 0.0513]);
        let mut model = SampledModel { step_s, ..SampledModel::default() };
        for i in 0..20_000 {
            let t = f64::from(i) * step_s;
            let wave = |f: f64, phase: f64| (f * t + phase).sin();
            let gamma = crate::regression::Phi::of(
                9.81 + 0.3 * wave(2.0, 0.1),
                &Vector3::new(0.5 * wave(2.5, 0.0), 0.5 * wave(3.1, 1.0), 0.4 * wave(1.3, 2.0)),
                &Vector3::new(1.5 * wave(2.5, 1.6), 1.5 * wave(3.1, 2.6), 0.8 * wave(1.3, 3.6)),
            );
            model.time_s.push(t);
            model.gamma.push(gamma);
            model.upsilon.push(gamma.matrix() * truth);
        }
        model.runs.push(0..model.time_s.len());
        (model, truth)
    }

    #[test]
    fn least_squares_is_exact_without_noise() {
        let (model, truth) = model(0.002);
        let estimate = least_squares(&model).unwrap();
        assert!((estimate.theta - truth).norm() < 1e-9);
        assert!((estimate.history.theta.last().unwrap() - truth).norm() < 1e-9);
    }

    #[test]
    fn implicit_gradient_converges_where_the_explicit_one_diverges() {
        let (model, truth) = model(0.002);
        let nominal = SVector::from([1.79, 0.03, 0.0, 0.0, 0.03, 0.0, 0.04]);
        // sigma T g^2 = 30 * 0.002 * 9.81^2 = 5.8 > 2
        let implicit = gradient_descent(&model, &nominal, PAPER_SIGMA);
        assert!((implicit.theta - truth).norm() < 2e-3, "{}", implicit.theta);
        let mut explicit = nominal;
        for (gamma, upsilon) in model.gamma.iter().zip(&model.upsilon) {
            let gamma = gamma.matrix();
            explicit += gamma.transpose() * (upsilon - gamma * explicit) * (PAPER_SIGMA * model.step_s);
        }
        let size = explicit.norm();
        assert!(size.is_nan() || size > 1e3, "{explicit}");
    }
}
