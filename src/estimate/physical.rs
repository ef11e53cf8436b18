//! Physically possible inertias.
//!
//! About the centre of mass, the second moments of the mass, `Sigma = tr(J)/2 I - J`, are positive definite for every
//! real body. This is the condition of the pseudo-inertia and contains the triangle inequalities. `Sigma = L L^T` with
//! a positive diagonal of L satisfies it always.

use super::theta::{MOMENTS, THETA, Theta, ThetaCovariance, inertia_of, scale_of};
use nalgebra::{Matrix3, SMatrix, SVector};

/// Second moments of the mass, kg m^2.
#[must_use]
pub fn second_moments(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * (0.5 * inertia.trace()) - inertia
}

/// Whether the second moments are positive definite and the mass is positive.
#[must_use]
pub fn is_physical(theta: &Theta) -> bool {
    theta[0] > 0.0 && second_moments(&inertia_of(theta)).cholesky().is_some()
}

/// The physical parameters nearest to an estimate in the metric of its own covariance, by
/// Gauss-Newton over `L` (log-Cholesky). An estimate that is physical is returned unchanged. `None`
/// where the covariance is singular or nothing converges.
#[must_use]
pub fn nearest_physical(theta: &Theta, covariance: &ThetaCovariance, nominal: &Theta) -> Option<Theta> {
    if is_physical(theta) {
        return Some(*theta);
    }
    let scale = Theta::from_fn(|i, _| scale_of(nominal, i).max(1e-12));
    let scaled = SMatrix::<f64, THETA, THETA>::from_fn(|i, j| covariance[(i, j)] / (scale[i] * scale[j]));
    let root = (scaled + SMatrix::identity() * 1e-12).cholesky()?;
    let whitened = |candidate: &Theta| {
        root.l().solve_lower_triangular(&(candidate - theta).component_div(&scale)).unwrap_or_default()
    };
    let floor = 1e-3 * second_moments(&inertia_of(nominal)).trace() / 3.0;
    let unpack = |q: &LogCholesky| unpack(q, floor);
    let mut q = log_cholesky(nominal, floor).or_else(|| log_cholesky(&thickened(nominal), floor))?;
    let mut cost = whitened(&unpack(&q)).norm_squared();
    let mut damping = 1e-3;
    for _ in 0..200 {
        let residual = whitened(&unpack(&q));
        let jacobian = numeric_jacobian(&q, |q| whitened(&unpack(q)));
        let normal = jacobian.tr_mul(&jacobian);
        let damped = normal + SMatrix::from_diagonal(&(normal.diagonal() * damping).add_scalar(1e-12));
        let step = damped.cholesky()?.solve(&(-jacobian.tr_mul(&residual)));
        let trial = q + step;
        let trial_cost = whitened(&unpack(&trial)).norm_squared();
        if trial_cost < cost {
            let gained = cost - trial_cost;
            (q, cost, damping) = (trial, trial_cost, damping * 0.3);
            if gained < 1e-10 * cost.max(1e-12) {
                break;
            }
        } else {
            damping *= 4.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    Some(unpack(&q)).filter(is_physical)
}

/// A body that is thicker in all directions, from which the search can begin where the stated one is flat.
fn thickened(theta: &Theta) -> Theta {
    let by = 0.1 * MOMENTS.iter().map(|&moment| theta[moment]).sum::<f64>() / 3.0;
    Theta::from_fn(|index, _| if MOMENTS.contains(&index) { theta[index] + by } else { theta[index] })
}

/// ln m, ln L11, ln L22, ln L33, L21, L31, L32; the off-diagonals in units of the root of the trace.
type LogCholesky = SVector<f64, THETA>;

fn log_cholesky(theta: &Theta, floor: f64) -> Option<LogCholesky> {
    let l = (second_moments(&inertia_of(theta)) - Matrix3::identity() * floor).cholesky()?.l();
    (theta[0] > 0.0).then(|| {
        SVector::from([
            theta[0].ln(),
            l[(0, 0)].ln(),
            l[(1, 1)].ln(),
            l[(2, 2)].ln(),
            l[(1, 0)] / l[(0, 0)],
            l[(2, 0)] / l[(0, 0)],
            l[(2, 1)] / l[(1, 1)],
        ])
    })
}

fn unpack(q: &LogCholesky, floor: f64) -> Theta {
    let diagonal = [q[1].exp(), q[2].exp(), q[3].exp()];
    let l = Matrix3::new(
        diagonal[0],
        0.0,
        0.0,
        q[4] * diagonal[0],
        diagonal[1],
        0.0,
        q[5] * diagonal[0],
        q[6] * diagonal[1],
        diagonal[2],
    );
    let sigma = l * l.transpose() + Matrix3::identity() * floor;
    let j = Matrix3::identity() * sigma.trace() - sigma;
    SVector::from([q[0].exp(), j[(0, 0)], j[(0, 1)], j[(0, 2)], j[(1, 1)], j[(1, 2)], j[(2, 2)]])
}

fn numeric_jacobian(q: &LogCholesky, residual: impl Fn(&LogCholesky) -> Theta) -> SMatrix<f64, THETA, THETA> {
    const STEP: f64 = 1e-6;
    let mut jacobian = SMatrix::<f64, THETA, THETA>::zeros();
    for column in 0..THETA {
        let (mut ahead, mut behind) = (*q, *q);
        ahead[column] += STEP;
        behind[column] -= STEP;
        let slope = (residual(&ahead) - residual(&behind)) / (2.0 * STEP);
        jacobian.set_column(column, &slope);
    }
    jacobian
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_physical_estimate_is_left_alone() {
        let theta = SVector::from([1.8, 0.03, 0.001, 0.0, 0.03, 0.0, 0.05]);
        assert_eq!(nearest_physical(&theta, &ThetaCovariance::identity(), &theta), Some(theta));
    }

    #[test]
    fn a_broken_triangle_inequality_is_mended_where_it_is_least_certain() {
        // Izz = 0.09 > Ixx + Iyy = 0.06, and Izz is by far the least certain
        let theta: Theta = SVector::from([1.8, 0.03, 0.0, 0.0, 0.03, 0.0, 0.09]);
        assert!(!is_physical(&theta));
        let nominal: Theta = SVector::from([1.8, 0.03, 0.0, 0.0, 0.03, 0.0, 0.05]);
        let deviations = [0.01, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 3e-2];
        let covariance = SMatrix::from_diagonal(&SVector::from(deviations.map(|s: f64| s * s)));
        let mended = nearest_physical(&theta, &covariance, &nominal).unwrap();
        assert!(is_physical(&mended));
        assert!((mended[1] / 0.03 - 1.0).abs() < 0.01, "{mended}");
        assert!((mended[6] / 0.06 - 1.0).abs() < 0.02, "{mended}");
    }

    #[test]
    fn a_flat_body_is_no_reason_to_find_none() {
        let flat: Theta = SVector::from([1.0, 0.044, 0.0, 0.0, 0.044, 0.0, 0.088]);
        let theta: Theta = SVector::from([1.0, 0.0198, 0.0, 0.0, 0.0200, 0.0, 0.0399]);
        let deviations = [0.01, 1e-4, 1e-5, 1e-5, 1e-4, 1e-5, 2e-4];
        let covariance = SMatrix::from_diagonal(&SVector::from(deviations.map(|s: f64| s * s)));
        let mended = nearest_physical(&theta, &covariance, &flat).unwrap();
        assert!(is_physical(&mended) && (mended - theta).norm() < 2e-4, "{mended}");
    }

    #[test]
    fn log_cholesky_round_trip() {
        let theta: Theta = SVector::from([2.06, 0.0217, 0.0004, -0.0009, 0.0231, 0.0005, 0.0402]);
        let back = unpack(&log_cholesky(&theta, 1e-6).unwrap(), 1e-6);
        assert!((back - theta).norm() < 1e-12);
    }
}
