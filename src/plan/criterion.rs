//! What is minimised: cond(W) as in (21), cond of the scaled W, D- and A-optimality.
//!
//! Each is a function of the 7 x 7 matrix `G = W^T D W` alone, taken on a logarithmic scale. The two
//! condition numbers have a kink where eigenvalues meet, and their optima lie on such kinks; so a
//! criterion is handed out as *supports*: linear functions of `G` that touch it, as many as matter.

use super::information::Matrix7;
use nalgebra::{SVector, SymmetricEigen};
use serde::{Deserialize, Serialize};

/// Criterion of an excitation trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Condition number of `W` (20), the paper's. It depends on the units of the parameters.
    Cond,
    /// Condition number of `W` with its columns scaled to unit norm. It does not depend on the size of the motion: use
    /// it for comparisons, not for a plan with high accuracy.
    ScaledCond,
    /// Volume of the error ellipsoid: the seventh root of the determinant of the covariance, square root.
    DOpt,
    /// Root mean square of the relative standard errors.
    AOpt,
}

impl Criterion {
    /// The name in files and arguments.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cond => "cond",
            Self::ScaledCond => "scaled-cond",
            Self::DOpt => "d-opt",
            Self::AOpt => "a-opt",
        }
    }
}

/// A linear function of `G` that touches one term of a criterion:
/// `value + <slope, G' - G>` for another matrix `G'`.
#[derive(Debug, Clone)]
pub struct Support {
    /// the criterion is the sum over terms of the largest support of each
    pub term: usize,
    /// value of the function at `G`
    pub value: f64,
    /// its slope by the entries of `G`
    pub slope: Matrix7,
}

/// Eigenvalues beyond this many times the extreme one are not candidates for it. Only the time of a plan depends on
/// it: candidates that are left out have no influence within a step.
const CANDIDATE_RATIO: f64 = 4.0;

impl Criterion {
    /// The logarithm of the criterion. `scale` is the size to which each parameter's error is compared (kg, kg m^2).
    /// Infinite for a singular matrix.
    #[must_use]
    pub fn log_value(self, gram: &Matrix7, scale: &SVector<f64, 7>) -> f64 {
        let value = match self {
            Self::Cond => log_condition(gram),
            Self::ScaledCond => log_condition(&unit_columns(gram)),
            Self::DOpt => gram.cholesky().map_or(f64::INFINITY, |c| {
                let log_root: f64 = c.l().diagonal().iter().map(|value| value.ln()).sum();
                -(log_root + scale.iter().map(|s| s.ln()).sum::<f64>()) / 7.0
            }),
            Self::AOpt => gram
                .cholesky()
                .map_or(f64::INFINITY, |c| 0.5 * (relative_trace(&c.inverse(), scale) / 7.0).ln()),
        };
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Number of terms of the criterion.
    #[must_use]
    pub fn terms(self) -> usize {
        match self {
            Self::Cond | Self::ScaledCond => 2,
            Self::DOpt | Self::AOpt => 1,
        }
    }

    /// True for a term that is convex in `G`: then its supports hold everywhere, and supports at other
    /// matrices may be used together with those at this one.
    #[must_use]
    pub fn is_convex(self, term: usize) -> bool {
        match self {
            Self::Cond => term == 1,
            Self::ScaledCond => false,
            Self::DOpt | Self::AOpt => true,
        }
    }

    /// The supports at `gram`. `None` where the matrix is singular.
    #[must_use]
    pub fn supports(self, gram: &Matrix7, scale: &SVector<f64, 7>) -> Option<Vec<Support>> {
        if gram.iter().any(|value| !value.is_finite()) {
            return None;
        }
        match self {
            Self::Cond => condition_supports(gram),
            Self::ScaledCond => {
                let supports = condition_supports(&unit_columns(gram))?;
                Some(supports.into_iter().map(|support| through_scaling(support, gram)).collect())
            }
            Self::DOpt => {
                let slope = gram.cholesky()?.inverse() * (-0.5 / 7.0);
                Some(vec![Support { term: 0, value: self.log_value(gram, scale), slope }])
            }
            Self::AOpt => {
                let inverse = gram.cholesky()?.inverse();
                let weight = Matrix7::from_diagonal(&scale.map(|s| 1.0 / (s * s)));
                let slope = inverse * weight * inverse * (-0.5 / relative_trace(&inverse, scale));
                Some(vec![Support { term: 0, value: self.log_value(gram, scale), slope }])
            }
        }
    }
}

/// The condition number of `W` from `W^T W`.
#[must_use]
pub fn condition_number(gram: &Matrix7) -> f64 {
    log_condition(gram).exp()
}

/// The condition number of `W` with columns of unit norm, from `W^T W`.
#[must_use]
pub fn scaled_condition_number(gram: &Matrix7) -> f64 {
    log_condition(&unit_columns(gram)).exp()
}

/// `log cond(W)`, half the log ratio of the eigenvalues of `W^T W`.
fn log_condition(gram: &Matrix7) -> f64 {
    if gram.iter().any(|value| !value.is_finite()) {
        return f64::INFINITY;
    }
    let eigenvalues = gram.symmetric_eigenvalues();
    let (min, max) = (eigenvalues.min(), eigenvalues.max());
    if min > 0.0 { 0.5 * (max / min).ln() } else { f64::INFINITY }
}

fn unit_columns(gram: &Matrix7) -> Matrix7 {
    let scale = gram.diagonal().map(|value| 1.0 / value.sqrt());
    Matrix7::from_fn(|row, column| gram[(row, column)] * scale[row] * scale[column])
}

/// Converts a support of the scaled matrix to one of `gram`.
fn through_scaling(support: Support, gram: &Matrix7) -> Support {
    let scaled = unit_columns(gram);
    let diagonal = gram.diagonal();
    let mut slope = Matrix7::from_fn(|row, column| {
        support.slope[(row, column)] / (diagonal[row] * diagonal[column]).sqrt()
    });
    let by_entry = support.slope.component_mul(&scaled);
    for k in 0..7 {
        slope[(k, k)] -= by_entry.row(k).sum() / diagonal[k];
    }
    Support { slope, ..support }
}

/// Term 0: `1/2 log(largest)`; term 1: `-1/2 log(smallest)`.
fn condition_supports(gram: &Matrix7) -> Option<Vec<Support>> {
    let eigen = SymmetricEigen::new(*gram);
    let (min, max) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
    if min <= 0.0 {
        return None;
    }
    let mut supports = Vec::new();
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        let outer = vector * vector.transpose();
        let half_log = 0.5 * value.ln();
        if value * CANDIDATE_RATIO > max {
            supports.push(Support { term: 0, value: half_log, slope: outer * (0.5 / value) });
        }
        if *value < CANDIDATE_RATIO * min {
            supports.push(Support { term: 1, value: -half_log, slope: outer * (-0.5 / value) });
        }
    }
    Some(supports)
}

fn relative_trace(covariance: &Matrix7, scale: &SVector<f64, 7>) -> f64 {
    (0..7).map(|k| covariance[(k, k)] / (scale[k] * scale[k])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(shift: f64) -> Matrix7 {
        let root = Matrix7::from_fn(|row, column| {
            let phase = 1.7 * row as f64 + 0.9 * column as f64 * column as f64;
            (phase + shift).sin() + if row == column { 2.0 } else { 0.0 }
        });
        root * root.transpose()
    }

    #[test]
    fn supports_touch_and_have_the_slope() {
        let scale = SVector::from([1.8, 0.03, 0.02, 0.02, 0.03, 0.02, 0.05]);
        let (gram, h) = (sample(0.0), 1e-6);
        let change = sample(0.8);
        for criterion in [Criterion::Cond, Criterion::ScaledCond, Criterion::DOpt, Criterion::AOpt] {
            let supports = criterion.supports(&gram, &scale).unwrap();
            let touching: Vec<&Support> = (0..criterion.terms())
                .map(|term| {
                    let of_term = supports.iter().filter(|s| s.term == term);
                    of_term.max_by(|a, b| a.value.total_cmp(&b.value)).unwrap()
                })
                .collect();
            let sum: f64 = touching.iter().map(|s| s.value).sum();
            assert!((sum - criterion.log_value(&gram, &scale)).abs() < 1e-12, "{criterion:?}");
            let slope: f64 = touching.iter().map(|s| s.slope.component_mul(&change).sum()).sum();
            let at = |step: f64| criterion.log_value(&(gram + change * step), &scale);
            assert!((slope - (at(h) - at(-h)) / (2.0 * h)).abs() < 1e-7, "{criterion:?}");
        }
    }

    #[test]
    fn condition_is_that_of_the_singular_values() {
        let gram = Matrix7::from_diagonal(&SVector::from([698.0, 64.0, 60.0, 55.0, 50.0, 47.0, 43.0]));
        let gram = gram * gram;
        assert!((condition_number(&gram) - 698.0 / 43.0).abs() < 1e-9);
        assert!((scaled_condition_number(&gram) - 1.0).abs() < 1e-12);
        assert_eq!(condition_number(&Matrix7::zeros()), f64::INFINITY);
    }
}
