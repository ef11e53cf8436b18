//! What is minimised: cond(W) as in (21), cond of the scaled W, D- and A-optimality.
//!
//! Each is written as a sum of maxima of smooth pieces, on a logarithmic scale. The two condition
//! numbers have a kink where eigenvalues meet, and their optima lie on such kinks; so every eigenvalue
//! that could become the extreme one is a piece of its own.

use super::information::{Matrix7, SlopedGram};
use nalgebra::{DVector, SVector, SymmetricEigen};
use serde::{Deserialize, Serialize};

/// What an excitation trajectory is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Condition number of `W` (20), the paper's. It depends on the units of the parameters.
    Cond,
    /// Condition number of `W` with its columns scaled to unit norm. It is blind to the size of the
    /// motion: use it to compare, not to plan for accuracy.
    ScaledCond,
    /// Log determinant of the inverse information matrix: the volume of the error ellipsoid.
    DOpt,
    /// Sum of the squared relative standard errors.
    AOpt,
}

/// One smooth function that bounds a criterion from below.
#[derive(Debug, Clone)]
pub struct Piece {
    /// value here
    pub value: f64,
    /// slope by the unknowns
    pub gradient: DVector<f64>,
}

/// Eigenvalues closer than this ratio may swap places within a step: their plane gets two more pieces.
const CLOSE_RATIO: f64 = 2.0;

impl Criterion {
    /// The logarithm of the criterion for a Gram matrix. `scale` is the size against which each
    /// parameter's error is measured (kg, kg m^2); only A-optimality uses it.
    /// Infinite where the matrix is singular.
    #[must_use]
    pub fn log_value(self, gram: &Matrix7, scale: &SVector<f64, 7>) -> f64 {
        let value = match self {
            Self::Cond => log_condition(gram),
            Self::ScaledCond => log_condition(&unit_columns(gram)),
            Self::DOpt => gram.cholesky().map_or(f64::INFINITY, |c| -log_determinant(&c.l())),
            Self::AOpt => {
                gram.try_inverse().map_or(f64::INFINITY, |inverse| relative_trace(&inverse, scale).ln())
            }
        };
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// The pieces whose maxima, one a group, add up to the logarithm of the criterion.
    /// `None` where the matrix is singular.
    #[must_use]
    pub fn pieces(self, gram: &SlopedGram, scale: &SVector<f64, 7>) -> Option<Vec<Vec<Piece>>> {
        match self {
            Self::Cond => condition_pieces(gram),
            Self::ScaledCond => condition_pieces(&with_unit_columns(gram)),
            Self::DOpt => {
                let inverse = gram.matrix.cholesky()?.inverse();
                let value = self.log_value(&gram.matrix, scale);
                let gradient = by_unknown(gram, |slope| -inverse.component_mul(slope).sum());
                Some(vec![vec![Piece { value, gradient }]])
            }
            Self::AOpt => {
                let inverse = gram.matrix.cholesky()?.inverse();
                let trace = relative_trace(&inverse, scale);
                let weight = Matrix7::from_diagonal(&scale.map(|s| 1.0 / (s * s)));
                let sandwich = inverse * weight * inverse;
                let gradient = by_unknown(gram, |slope| -sandwich.component_mul(slope).sum() / trace);
                Some(vec![vec![Piece { value: trace.ln(), gradient }]])
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

fn with_unit_columns(gram: &SlopedGram) -> SlopedGram {
    let matrix = unit_columns(&gram.matrix);
    let diagonal = gram.matrix.diagonal();
    let scale = diagonal.map(|value| 1.0 / value.sqrt());
    let slopes = gram.slopes.iter().map(|slope| {
        let change = SVector::<f64, 7>::from_fn(|k, _| 0.5 * slope[(k, k)] / diagonal[k]);
        Matrix7::from_fn(|row, column| {
            slope[(row, column)] * scale[row] * scale[column]
                - matrix[(row, column)] * (change[row] + change[column])
        })
    });
    SlopedGram { slopes: slopes.collect(), matrix }
}

/// Pieces of `1/2 log(largest)` and of `-1/2 log(smallest)`.
fn condition_pieces(gram: &SlopedGram) -> Option<Vec<Vec<Piece>>> {
    if gram.matrix.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::new(gram.matrix);
    let values = eigen.eigenvalues;
    if values.min() <= 0.0 {
        return None;
    }
    let (min, max) = (values.min(), values.max());
    let mut directions: Vec<(f64, SVector<f64, 7>)> = Vec::new();
    for first in 0..7 {
        let direction = eigen.eigenvectors.column(first).into_owned();
        directions.push((values[first], direction));
        for second in first + 1..7 {
            let ratio = values[first] / values[second];
            if ratio.max(1.0 / ratio) < CLOSE_RATIO {
                let other = eigen.eigenvectors.column(second).into_owned();
                let mean = 0.5 * (values[first] + values[second]);
                directions.push((mean, (direction + other) * std::f64::consts::FRAC_1_SQRT_2));
                directions.push((mean, (direction - other) * std::f64::consts::FRAC_1_SQRT_2));
            }
        }
    }
    let group = |sign: f64, keep: &dyn Fn(f64) -> bool| -> Vec<Piece> {
        let kept = directions.iter().filter(|(value, _)| keep(*value));
        kept.map(|(value, v)| Piece {
            value: sign * 0.5 * value.ln(),
            gradient: by_unknown(gram, |slope| sign * 0.5 * v.dot(&(slope * v)) / value),
        })
        .collect()
    };
    Some(vec![
        group(1.0, &|value| value * CLOSE_RATIO > max),
        group(-1.0, &|value| value < CLOSE_RATIO * CLOSE_RATIO * min),
    ])
}

fn by_unknown(gram: &SlopedGram, slope_of: impl Fn(&Matrix7) -> f64) -> DVector<f64> {
    DVector::from_iterator(gram.slopes.len(), gram.slopes.iter().map(slope_of))
}

fn log_determinant(lower: &Matrix7) -> f64 {
    2.0 * lower.diagonal().iter().map(|value| value.ln()).sum::<f64>()
}

fn relative_trace(covariance: &Matrix7, scale: &SVector<f64, 7>) -> f64 {
    (0..7).map(|k| covariance[(k, k)] / (scale[k] * scale[k])).sum()
}
