//! The Euler-angle kinematics (4) of the paper, needed where its PID works on angles.

use nalgebra::Matrix3;

/// `W(eta)` of (4): body rates to Euler rates for roll and pitch (rad). Singular at pitch = 90 deg.
#[must_use]
pub fn euler_rates(roll_rad: f64, pitch_rad: f64) -> Matrix3<f64> {
    let (sr, cr) = roll_rad.sin_cos();
    let (tp, cp) = (pitch_rad.tan(), pitch_rad.cos());
    Matrix3::new(1.0, sr * tp, cr * tp, 0.0, cr, -sr, 0.0, sr / cp, cr / cp)
}

/// `W(eta)^-1`: Euler rates to body rates; regular everywhere.
#[must_use]
pub fn euler_rates_inverse(roll_rad: f64, pitch_rad: f64) -> Matrix3<f64> {
    let (sr, cr) = roll_rad.sin_cos();
    let (sp, cp) = pitch_rad.sin_cos();
    Matrix3::new(1.0, 0.0, -sp, 0.0, cr, sr * cp, 0.0, -sr, cr * cp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Attitude;
    use nalgebra::{UnitQuaternion, Vector3};

    #[test]
    fn inverse_is_the_inverse() {
        let product = euler_rates(0.4, -0.9) * euler_rates_inverse(0.4, -0.9);
        assert!((product - Matrix3::identity()).norm() < 1e-12);
    }

    #[test]
    fn euler_rates_agree_with_the_turning_quaternion() {
        let (roll, pitch, yaw) = (0.3, -0.5, 1.0);
        let w = Vector3::new(0.7, -0.4, 0.9);
        let h = 1e-6;
        let later = Attitude::from_euler(roll, pitch, yaw).0 * UnitQuaternion::from_scaled_axis(w * h);
        let (r, p, y) = later.euler_angles();
        let numeric = Vector3::new(r - roll, p - pitch, y - yaw) / h;
        assert!((numeric - euler_rates(roll, pitch) * w).norm() < 1e-5);
    }

    #[test]
    fn rotation_matrix_is_the_papers() {
        let (roll, pitch, yaw) = (0.3_f64, -0.2_f64, 1.1_f64);
        let r = Attitude::from_euler(roll, pitch, yaw).0.to_rotation_matrix();
        let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        let printed = Matrix3::new(
            cp * cy,
            sp * cy * sr - sy * cr,
            sp * cy * cr + sy * sr,
            cp * sy,
            sp * sy * sr + cy * cr,
            sp * sy * cr - cy * sr,
            -sp,
            cp * sr,
            cp * cr,
        );
        assert!((r.matrix() - printed).norm() < 1e-12);
    }
}
