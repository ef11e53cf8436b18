//! The filtered regression model (13) to (17): no acceleration is needed, because
//! `d/dt Phi_a(v, w) + Phi_b(v, w, eta)` takes its derivative in a filter.
//!
//! The same split serves the weak form, whose derivative is taken by its kernel.

use nalgebra::{SMatrix, Vector3};

/// `Phi_a` after (17): `[m w; I omega] = Phi_a Theta`. Rows Fz, torques; columns m, Ixx, Ixy, Ixz,
/// Iyy, Iyz, Izz. `vertical_velocity` is w, body, m/s; `omega` in rad/s.
#[must_use]
pub fn momentum_regressor(vertical_velocity: f64, omega: &Vector3<f64>) -> SMatrix<f64, 4, 7> {
    let (p, q, r) = (omega.x, omega.y, omega.z);
    let mut phi = SMatrix::<f64, 4, 7>::zeros();
    phi[(0, 0)] = vertical_velocity;
    phi.fixed_view_mut::<3, 6>(1, 1).copy_from(&SMatrix::<f64, 3, 6>::from_row_slice(&[
        p, q, r, 0.0, 0.0, 0.0, //
        0.0, p, 0.0, q, r, 0.0, //
        0.0, 0.0, p, 0.0, q, r,
    ]));
    phi
}

/// `Phi_b` after (17), its last row as (10) gives it (the paper prints `qr` for `pq` in column Iyy).
/// `vertical` is `p v - q u + g_bz`, m/s^2.
#[must_use]
pub fn gyroscopic_regressor(vertical: f64, omega: &Vector3<f64>) -> SMatrix<f64, 4, 7> {
    let mut phi = gyroscopic_from_products(&RATE_PAIRS.map(|(i, j)| omega[i] * omega[j]));
    phi[(0, 0)] = vertical;
    phi
}

/// Which rates make each of the products that `Phi_b` is linear in: pp, qq, rr, pq, pr, qr.
pub const RATE_PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The torque rows of `Phi_b` from the products of [`RATE_PAIRS`], filtered or not (rad^2/s^2).
#[must_use]
pub fn gyroscopic_from_products(products: &[f64; 6]) -> SMatrix<f64, 4, 7> {
    let [pp, qq, rr, pq, pr, qr] = *products;
    let mut phi = SMatrix::<f64, 4, 7>::zeros();
    phi.fixed_view_mut::<3, 6>(1, 1).copy_from(&SMatrix::<f64, 3, 6>::from_row_slice(&[
        0.0,
        -pr,
        pq,
        -qr,
        qq - rr,
        qr, //
        pr,
        qr,
        rr - pp,
        0.0,
        -pq,
        -pr, //
        -pq,
        pp - qq,
        -qr,
        pq,
        pr,
        0.0,
    ]));
    phi
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regression::{BodyKinematics, standard_regressor};

    #[test]
    fn the_split_adds_up_to_the_standard_regressor() {
        for k in 0..10 {
            let s = f64::from(k);
            let omega = Vector3::new((0.7 * s).sin(), 0.3 - 0.1 * s, (1.3 * s).cos());
            let omega_dot = Vector3::new(0.2 * s, (0.5 * s).cos(), -0.4);
            let (w_dot, vertical) = (0.3 * s, 9.7 - 0.02 * s);
            // Phi_a is linear: its time derivative is Phi_a of the derivatives
            let split = momentum_regressor(w_dot, &omega_dot) + gyroscopic_regressor(vertical, &omega);
            let whole = standard_regressor(&BodyKinematics {
                specific_force_z_m_s2: w_dot + vertical,
                omega_rad_s: omega,
                omega_dot_rad_s2: omega_dot,
            });
            assert!((split - whole).norm() < 1e-12);
        }
    }
}
