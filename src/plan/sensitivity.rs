//! Derivatives of the motion and of the regressor of one instant with respect to the path.

use super::space::Path;
use crate::regression::{BodyKinematics, standard_regressor};
use crate::trajectory::{Dual, FlatMotion, Scalar, flat_motion};
use nalgebra::{SMatrix, Vector3};

/// Inputs of the flat map: acceleration with two derivatives of x, y, z, then yaw with two.
pub const INPUTS: usize = 12;

/// A number with its slope by every input of the flat map.
pub type Sensitive = Dual<INPUTS>;

/// The motion that a path needs.
#[must_use]
pub fn motion_of(path: &Path, gravity_m_s2: f64) -> FlatMotion<f64> {
    let (acceleration, yaw) = flat_inputs(path, |value, _| value);
    flat_motion(&acceleration, &yaw, gravity_m_s2)
}

/// The motion that a path needs, with its slopes.
#[must_use]
pub fn sensitive_motion_of(path: &Path, gravity_m_s2: f64) -> FlatMotion<Sensitive> {
    let (acceleration, yaw) = flat_inputs(path, Sensitive::input);
    flat_motion(&acceleration, &yaw, gravity_m_s2)
}

fn flat_inputs<S: Scalar>(path: &Path, input: impl Fn(f64, usize) -> S) -> ([[S; 3]; 3], [S; 3]) {
    let acceleration =
        std::array::from_fn(|axis| std::array::from_fn(|k| input(path[axis][2 + k], 3 * axis + k)));
    let yaw = std::array::from_fn(|k| input(path[3][k], 9 + k));
    (acceleration, yaw)
}

/// Slopes by input as slopes by path entry.
#[must_use]
pub fn path_slope(by_input: &[f64; INPUTS]) -> Path {
    let mut slope = Path::default();
    for axis in 0..3 {
        slope[axis][2..].copy_from_slice(&by_input[3 * axis..3 * axis + 3]);
    }
    slope[3][..3].copy_from_slice(&by_input[9..]);
    slope
}

/// What the regressor needs of a motion.
#[must_use]
pub fn kinematics_of(motion: &FlatMotion<f64>) -> BodyKinematics {
    BodyKinematics {
        specific_force_z_m_s2: motion.specific_force,
        omega_rad_s: Vector3::from(motion.omega),
        omega_dot_rad_s2: Vector3::from(motion.omega_dot),
    }
}

/// The seven numbers on which the regressor depends: specific force, rates, angular accelerations.
#[must_use]
pub fn regressor_inputs<S: Copy>(motion: &FlatMotion<S>) -> [S; 7] {
    let (rates, accelerations) = (motion.omega, motion.omega_dot);
    [
        motion.specific_force,
        rates[0],
        rates[1],
        rates[2],
        accelerations[0],
        accelerations[1],
        accelerations[2],
    ]
}

/// Slope of the regressor (12) by each of [`regressor_inputs`]. `Phi` is of second degree in them, so
/// the central difference with a step of one is exact.
#[must_use]
pub fn regressor_slopes(inputs: &[f64; 7]) -> [SMatrix<f64, 4, 7>; 7] {
    let at = |inputs: [f64; 7]| {
        let [force, p, q, r, dp, dq, dr] = inputs;
        standard_regressor(&BodyKinematics {
            specific_force_z_m_s2: force,
            omega_rad_s: Vector3::new(p, q, r),
            omega_dot_rad_s2: Vector3::new(dp, dq, dr),
        })
    };
    std::array::from_fn(|k| {
        let (mut above, mut below) = (*inputs, *inputs);
        above[k] += 1.0;
        below[k] -= 1.0;
        (at(above) - at(below)) * 0.5
    })
}
