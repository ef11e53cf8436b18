//! What the flight will determine, and how well: relative standard errors before it is flown.
//!
//! Identification regresses the logged force and torque on the measured motion (the weak form, with the
//! command on the left-hand side), so the noise of a row is what the force or torque balance shows when
//! nothing is wrong: the accelerometer and the commands' jitter in force, the jitter and the gyro's
//! noise in torque. The command loop runs faster than the log; a logged command is one tick of it, while
//! the body feels the mean of all ticks. This aliased jitter is the largest noise of the torque rows. It
//! is the controller's answer to the noise on which it flies, an angular acceleration times the inertia
//! that the controller believes in, and so it does not follow from the rotors.
//!
//! Each noise is taken as white. The jitter of a real loop is coloured by its controller, so a promise
//! may be off by some ten per cent for one parameter or another.

use super::bounds::parameters_of;
use super::information::Matrix7;
use crate::vehicle::Vehicle;
use nalgebra::{SVector, Vector4};

/// Noise of the balances (7) to (10) as a weak-form regression sees them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// accelerometer, one axis, m/s^2, one sample
    pub accelerometer_m_s2: f64,
    /// gyro, one axis, rad/s, one sample
    pub gyro_rad_s: f64,
    /// difference between a logged thrust command and the mean that acted, as thrust per mass, m/s^2
    pub thrust_jitter_m_s2: f64,
    /// the same of the torque commands, as angular acceleration about body x, y, z, rad/s^2
    pub torque_jitter_rad_s2: [f64; 3],
    /// rate at which accelerometer, gyro and commands are logged, 1/s; samples count as independent
    pub log_rate_hz: f64,
    /// half the width of the weak form's kernel, s; it sets the noise of the gyro's derivative
    pub kernel_half_width_s: f64,
}

impl Default for NoiseModel {
    /// Sensors of the class of a Pixhawk, control at 250 Hz logged at 125 Hz. The jitter is that of this
    /// crate's simulated flights with their default controller; a test holds the two together.
    fn default() -> Self {
        Self {
            accelerometer_m_s2: 0.12,
            gyro_rad_s: 0.006,
            thrust_jitter_m_s2: 0.26,
            torque_jitter_rad_s2: [1.1, 1.3, 0.6],
            log_rate_hz: 125.0,
            kernel_half_width_s: 0.2,
        }
    }
}

impl NoiseModel {
    /// Inverse variance, per second of flight, of the balances Fz, `tau_x`, `tau_y`, `tau_z`
    /// (1/(N^2 s), 1/((N m)^2 s)).
    ///
    /// White noise of variance `s^2` at rate `f` has the density `s^2 / f`. The derivative of a gyro's
    /// white noise has, under a kernel of half width H, `c / H^2` times its density: `c = 34/7` for
    /// `(1 - s^2)^4`, the ratio of the integrals of the squared derivative and of the squared kernel.
    #[must_use]
    pub fn row_information(&self, vehicle: &Vehicle) -> Vector4<f64> {
        const KERNEL_RATIO: f64 = 34.0 / 7.0;
        let moments = vehicle.body.inertia_kg_m2.diagonal();
        Vector4::from_fn(|row, _| {
            let variance = if row == 0 {
                let square = self.accelerometer_m_s2.powi(2) + self.thrust_jitter_m_s2.powi(2);
                vehicle.body.mass_kg.powi(2) * square
            } else {
                let gyro = KERNEL_RATIO * (self.gyro_rad_s / self.kernel_half_width_s).powi(2);
                moments[row - 1].powi(2) * (gyro + self.torque_jitter_rad_s2[row - 1].powi(2))
            };
            self.log_rate_hz / variance
        })
    }
}

/// The size against which each parameter's error is measured (kg, kg m^2): mass and moments of inertia
/// themselves, and for the product of two axes the geometric mean of their moments.
#[must_use]
pub fn parameter_scale(vehicle: &Vehicle) -> SVector<f64, 7> {
    let theta = parameters_of(&vehicle.body);
    let (x, y, z) = (theta[1], theta[4], theta[6]);
    let mean = |a: f64, b: f64| (a * b).abs().sqrt();
    SVector::from([theta[0], x, mean(x, y), mean(x, z), y, mean(y, z), z])
}

/// Names of `Theta` in files and JSON.
pub const PARAMETERS: [&str; 7] = ["mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// Relative standard error of each parameter after `duration_s`, from the information a second of flight
/// brings. `None` where the flight cannot determine all of them.
#[must_use]
pub fn relative_standard_errors(
    information_per_s: &Matrix7,
    duration_s: f64,
    scale: &SVector<f64, 7>,
) -> Option<[f64; 7]> {
    let covariance = (information_per_s * duration_s).cholesky()?.inverse();
    Some(std::array::from_fn(|k| covariance[(k, k)].sqrt() / scale[k]))
}
