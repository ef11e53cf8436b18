//! Indices of states and parameters in their vectors.

/// Where each part of a state begins.
pub(super) const VELOCITY: usize = 0;
/// See [`VELOCITY`].
pub(super) const TILT: usize = 3;
/// See [`VELOCITY`].
pub(super) const ERROR: usize = 6;

/// Indices of the parameters that every problem has: nominal over true mass.
pub(super) const SCALE: usize = 0;
/// First of three: of the accelerometer, m/s^2.
pub(super) const BIAS: usize = 1;
/// Lateness of the commands, s.
pub(super) const LATE_FORCE: usize = 4;
/// Lag of the rotors, s.
pub(super) const LAG: usize = 5;
/// Lateness of the attitude, s.
pub(super) const LATE_ATTITUDE: usize = 6;
/// Lateness of the autopilot's velocity, s.
pub(super) const LATE_VELOCITY: usize = 7;
/// Lateness of the receiver's velocity, s.
pub(super) const LATE_RECEIVER: usize = 8;
/// Time by which the body turns between the force and the frame of its sample, s.
pub(super) const TURNED: usize = 9;
/// How many they are.
pub(super) const BASE: usize = 10;
