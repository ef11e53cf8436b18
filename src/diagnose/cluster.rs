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
