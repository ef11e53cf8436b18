//! Noise of the gyroscopes that the controller feeds back. Commands and measured motion share it, and least squares attributes
//! the controller's reaction to the vehicle.

use super::trace::Trace;

/// Noise of the gyroscopes above which the controller's answer matters, rad/s. Without vibration an autopilot's
/// gyroscope has far less.
const NOISY_RAD_S: f64 = 0.03;
/// Standard error of a latency by least squares where this noise is fed back and no instrument confirms it, s. On flights with an
/// estimator in the loop it was wrong by 2 to 40 ms.
pub(super) const UNCONFIRMED_S: f64 = 0.02;

/// Whether the gyroscopes' noise moves commands and motion of any of the flights together.
pub(super) fn is_fed_back(flights: &[Trace]) -> bool {
    flights.iter().any(|trace| trace.gyro_noise_rad_s > NOISY_RAD_S)
}
