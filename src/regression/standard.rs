//! The standard regression model (11) and (12): `Phi Theta = F`, with
//! `Theta = [m Ixx Ixy Ixz Iyy Iyz Izz]` and `F = [Fz tau_x tau_y tau_z]`.
//!
//! The paper prints `Phi` in two halves; the rows here are those of (7) to (10).

use super::Phi;
use nalgebra::{SMatrix, Vector3};

/// The motion of one instant as far as (7) to (10) need it. Body FLU, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyKinematics {
    /// `w' + p v - q u + g_bz`: what an ideal accelerometer on body z shows, m/s^2
    pub specific_force_z_m_s2: f64,
    /// `[p q r]`, rad/s
    pub omega_rad_s: Vector3<f64>,
    /// `[p' q' r']`, rad/s^2
    pub omega_dot_rad_s2: Vector3<f64>,
}

/// `Phi` of (12): rows Fz, `tau_x`, `tau_y`, `tau_z` (N, N m); columns m (kg), Ixx, Ixy, Ixz, Iyy, Iyz,
/// Izz (kg m^2).
#[must_use]
pub fn standard_regressor(kinematics: &BodyKinematics) -> SMatrix<f64, 4, 7> {
    let BodyKinematics { specific_force_z_m_s2, omega_rad_s, omega_dot_rad_s2 } = kinematics;
    Phi::of(*specific_force_z_m_s2, omega_rad_s, omega_dot_rad_s2).matrix()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, SVector};

    fn inertia_of(theta: &SVector<f64, 7>) -> Matrix3<f64> {
        let (xx, xy, xz, yy, yz, zz) = (theta[1], theta[2], theta[3], theta[4], theta[5], theta[6]);
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    #[test]
    fn equals_newton_and_euler() {
        let theta = SVector::from([1.8, 0.03, 0.002, -0.004, 0.035, 0.001, 0.05]);
        for k in 0..20 {
            let s = f64::from(k);
            let omega = Vector3::new((s * 0.7).sin(), (s * 1.1).cos(), 0.4 - 0.1 * s);
            let omega_dot = Vector3::new((s * 0.3).cos(), -0.2 * s, (s * 2.1).sin());
            let kinematics = BodyKinematics {
                specific_force_z_m_s2: 9.0 + 0.1 * s,
                omega_rad_s: omega,
                omega_dot_rad_s2: omega_dot,
            };
            let force = standard_regressor(&kinematics) * theta;
            let inertia = inertia_of(&theta);
            let torque = inertia * omega_dot + omega.cross(&(inertia * omega));
            assert!((force[0] - 1.8 * (9.0 + 0.1 * s)).abs() < 1e-12);
            assert!((force.fixed_rows::<3>(1) - torque).norm() < 1e-12);
        }
    }

    #[test]
    fn rows_are_those_of_7_to_10() {
        let (p, q, r) = (2.0, 3.0, 5.0);
        let (dp, dq, dr) = (7.0, 11.0, 13.0);
        let phi = standard_regressor(&BodyKinematics {
            specific_force_z_m_s2: 17.0,
            omega_rad_s: Vector3::new(p, q, r),
            omega_dot_rad_s2: Vector3::new(dp, dq, dr),
        });
        // (8): Ixx p' + Ixy (q' - p r) + Ixz (r' + p q) + Iyz (q^2 - r^2) + (Izz - Iyy) q r
        let expected = SMatrix::<f64, 4, 7>::from_row_slice(&[
            17.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            0.0, 7.0, 1.0, 19.0, -15.0, -16.0, 15.0, //
            0.0, 10.0, 22.0, 21.0, 11.0, 7.0, -10.0, //
            0.0, -6.0, -5.0, -8.0, 6.0, 21.0, 13.0,
        ]);
        assert_eq!(phi, expected);
    }
}
