//! The correlation of the parameters with one another.

use crate::estimate::{MethodResult, THETA};

pub(super) fn correlation(result: &MethodResult) -> Vec<Vec<Option<f64>>> {
    let covariance = &result.estimated.covariance;
    (0..THETA)
        .map(|i| {
            (0..THETA)
                .map(|j| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt())
                .map(|r| r.is_finite().then_some(r))
                .collect()
        })
        .collect()
}
