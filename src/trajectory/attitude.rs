//! The attitude that a path needs: roll and pitch from (26) and (27), body rates from (4), and their
//! derivatives, all analytic.
//!
//! With `X`, `Y`, `Z` the components of `p'' + g e_z` in the frame turned by yaw only,
//! `tan(theta) = X / Z` and `tan(phi) = -Y / sqrt(X^2 + Z^2)`: thrust points along `p'' + g e_z`, and
//! so the specific force along body z is its length.

use super::dual::Scalar;
use crate::frames::{Attitude, Body, World};
use nalgebra::Vector3;

/// A quantity and its first two time derivatives.
pub type Jet<S> = [S; 3];

/// What a path and a yaw say about the body, generic over plain numbers and duals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatMotion<S> {
    /// roll (27) and its derivatives, rad
    pub roll: Jet<S>,
    /// pitch (26) and its derivatives, rad
    pub pitch: Jet<S>,
    /// `[p q r]`, rad/s, body FLU
    pub omega: [S; 3],
    /// `[p' q' r']`, rad/s^2, body FLU
    pub omega_dot: [S; 3],
    /// `|p'' + g e_z|`, thrust per mass, m/s^2
    pub specific_force: S,
}

/// Roll, pitch, rates and angular accelerations from acceleration with its first two derivatives
/// (x, y, z; world NWU; m/s^2 and on) and yaw with its first two (rad). `gravity_m_s2` is positive.
///
/// In free fall (`p'' = -g e_z`) there is no attitude, and the results are not numbers.
#[must_use]
pub fn flat_motion<S: Scalar>(acceleration: &[Jet<S>; 3], yaw: &Jet<S>, gravity_m_s2: f64) -> FlatMotion<S> {
    let [x, y, mut z] = in_yaw_frame(acceleration, yaw);
    z[0] = z[0] + S::constant(gravity_m_s2);

    let pitch = angle(&x, &z);
    let in_plane = length(&x, &z);
    let roll = angle(&y, &in_plane).map(|value| -value);
    let force = (in_plane[0] * in_plane[0] + y[0] * y[0]).sqrt();

    let (sin_pitch, cos_pitch) = (x[0] / in_plane[0], z[0] / in_plane[0]);
    let (sin_roll, cos_roll) = (-y[0] / force, in_plane[0] / force);
    let [_, roll_1, roll_2] = roll;
    let [_, pitch_1, pitch_2] = pitch;
    let [_, yaw_1, yaw_2] = *yaw;

    // yaw rate along body y and z is yaw_1 * (sin_roll cos_pitch) and yaw_1 * (cos_roll cos_pitch)
    let (share_y, share_z) = (sin_roll * cos_pitch, cos_roll * cos_pitch);
    let share_y_1 = cos_roll * cos_pitch * roll_1 - sin_roll * sin_pitch * pitch_1;
    let share_z_1 = -(sin_roll * cos_pitch * roll_1) - cos_roll * sin_pitch * pitch_1;
    FlatMotion {
        roll,
        pitch,
        omega: [
            roll_1 - yaw_1 * sin_pitch,
            pitch_1 * cos_roll + yaw_1 * share_y,
            yaw_1 * share_z - pitch_1 * sin_roll,
        ],
        omega_dot: [
            roll_2 - yaw_2 * sin_pitch - yaw_1 * cos_pitch * pitch_1,
            pitch_2 * cos_roll - pitch_1 * sin_roll * roll_1 + yaw_2 * share_y + yaw_1 * share_y_1,
            yaw_2 * share_z + yaw_1 * share_z_1 - pitch_2 * sin_roll - pitch_1 * cos_roll * roll_1,
        ],
        specific_force: force,
    }
}

/// The vector turned by minus yaw about z, with the derivatives of the product.
fn in_yaw_frame<S: Scalar>(vector: &[Jet<S>; 3], yaw: &Jet<S>) -> [Jet<S>; 3] {
    let [x, y, z] = *vector;
    let (sin, cos) = yaw[0].sin_cos();
    let turn = |x: S, y: S| (cos * x + sin * y, cos * y - sin * x);
    let (along_0, across_0) = turn(x[0], y[0]);
    let (along_1, across_1) = turn(x[1], y[1]);
    let (along_2, across_2) = turn(x[2], y[2]);
    let (rate, rate_square) = (yaw[1], yaw[1] * yaw[1]);
    let two = S::constant(2.0);
    [
        [
            along_0,
            along_1 + rate * across_0,
            along_2 + two * rate * across_1 + yaw[2] * across_0 - rate_square * along_0,
        ],
        [
            across_0,
            across_1 - rate * along_0,
            across_2 - two * rate * along_1 - yaw[2] * along_0 - rate_square * across_0,
        ],
        z,
    ]
}

/// `atan2(y, x)` with derivatives.
fn angle<S: Scalar>(y: &Jet<S>, x: &Jet<S>) -> Jet<S> {
    let square = x[0] * x[0] + y[0] * y[0];
    let half_square_1 = x[0] * x[1] + y[0] * y[1];
    let first = (y[1] * x[0] - y[0] * x[1]) / square;
    let twice = half_square_1 + half_square_1;
    let second = (y[2] * x[0] - y[0] * x[2] - first * twice) / square;
    [y[0].atan2(x[0]), first, second]
}

/// `sqrt(x^2 + y^2)` with derivatives.
fn length<S: Scalar>(x: &Jet<S>, y: &Jet<S>) -> Jet<S> {
    let root = (x[0] * x[0] + y[0] * y[0]).sqrt();
    let first = (x[0] * x[1] + y[0] * y[1]) / root;
    let second = (x[1] * x[1] + x[0] * x[2] + y[1] * y[1] + y[0] * y[2] - first * first) / root;
    [root, first, second]
}

/// All that a reference says of one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// x, y, z (world NWU, m) and psi (rad), each with its first four time derivatives
    pub path: [[f64; 5]; 4],
    /// attitude, rates and thrust per mass
    pub motion: FlatMotion<f64>,
    /// `v`, m/s, body FLU, from (3)
    pub body_velocity_m_s: Vector3<f64>,
    /// `v'`, m/s^2, body FLU
    pub body_velocity_dot_m_s2: Vector3<f64>,
}

impl Reference {
    /// From position and yaw with their first four derivatives (world NWU, m, rad, s).
    #[must_use]
    pub fn new(path: [[f64; 5]; 4], gravity_m_s2: f64) -> Self {
        let [x, y, z, yaw] = path;
        let acceleration = [x, y, z].map(|axis| [axis[2], axis[3], axis[4]]);
        let motion = flat_motion(&acceleration, &[yaw[0], yaw[1], yaw[2]], gravity_m_s2);
        let attitude = Attitude::from_euler(motion.roll[0], motion.pitch[0], yaw[0]);
        let Body(velocity) = attitude.to_body(World(Vector3::new(x[1], y[1], z[1])));
        let Body(acceleration) = attitude.to_body(World(Vector3::new(x[2], y[2], z[2])));
        let omega = Vector3::from(motion.omega);
        Self {
            path,
            motion,
            body_velocity_m_s: velocity,
            body_velocity_dot_m_s2: acceleration - omega.cross(&velocity),
        }
    }

    /// Body to world.
    #[must_use]
    pub fn attitude(&self) -> Attitude {
        Attitude::from_euler(self.motion.roll[0], self.motion.pitch[0], self.path[3][0])
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FourierAxis, FourierTrajectory};
    use super::*;
    use crate::frames::skew;

    const GRAVITY: f64 = 9.81;

    fn trajectory() -> FourierTrajectory {
        let axis =
            |s: f64| FourierAxis { a: vec![0.3 * s, -0.8, 0.5 * s], b: vec![0.9, 0.4 * s, -0.7], c: 0.5 * s };
        FourierTrajectory { period_s: 4.0, axes: [axis(1.0), axis(-0.6), axis(0.4), axis(1.3)] }
    }

    fn reference(t_s: f64) -> Reference {
        Reference::new(trajectory().derivatives(t_s), GRAVITY)
    }

    #[test]
    fn roll_and_pitch_are_26_and_27() {
        for k in 0..20 {
            let now = reference(0.2 * f64::from(k));
            let [x, y, z, yaw] = now.path;
            let (sin, cos) = yaw[0].sin_cos();
            let pitch = ((cos * x[2] + sin * y[2]) / (z[2] + GRAVITY)).atan();
            let roll = (pitch.cos() * (sin * x[2] - cos * y[2]) / (z[2] + GRAVITY)).atan();
            assert!((now.motion.pitch[0] - pitch).abs() < 1e-14);
            assert!((now.motion.roll[0] - roll).abs() < 1e-14);
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let h = 1e-4;
        for k in 0..20 {
            let t = 0.2 * f64::from(k);
            let (before, now, after) = (reference(t - h), reference(t), reference(t + h));
            let check = |numeric: f64, analytic: f64| assert!((numeric - analytic).abs() < 2e-5);
            for order in 0..2 {
                let pairs = [
                    (before.motion.roll, now.motion.roll, after.motion.roll),
                    (before.motion.pitch, now.motion.pitch, after.motion.pitch),
                ];
                for (b, n, a) in pairs {
                    check((a[order] - b[order]) / (2.0 * h), n[order + 1]);
                }
            }
            for axis in 0..3 {
                let difference = after.motion.omega[axis] - before.motion.omega[axis];
                check(difference / (2.0 * h), now.motion.omega_dot[axis]);
                let difference = after.body_velocity_m_s[axis] - before.body_velocity_m_s[axis];
                check(difference / (2.0 * h), now.body_velocity_dot_m_s2[axis]);
            }
            // R' = R S(w)
            let rotation = |r: &Reference| r.attitude().0.to_rotation_matrix().into_inner();
            let numeric = (rotation(&after) - rotation(&before)) / (2.0 * h);
            let analytic = rotation(&now) * skew(&now.motion.omega.into());
            assert!((numeric - analytic).norm() < 2e-5);
        }
    }

    #[test]
    fn thrust_is_along_body_z() {
        let now = reference(0.9);
        let [x, y, z, _] = now.path;
        let force = World(Vector3::new(x[2], y[2], z[2] + GRAVITY));
        let Body(seen) = now.attitude().to_body(force);
        assert!((seen - Vector3::new(0.0, 0.0, now.motion.specific_force)).norm() < 1e-12);
    }
}
