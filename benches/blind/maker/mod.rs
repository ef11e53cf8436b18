//! A second maker of test flights, which shares no equation with the library: a rigid body with a rotation
//! matrix, rotors one by one, an adaptive Dormand-Prince integrator, a geometric controller on noisy estimates,
//! and a telemetry log as a PX4 vehicle's ground station would have recorded it.
//!
//! World north, west, up; body x forward, y left, z up; SI. A rotor's `spin` is +1 where it turns counter-clockwise
//! seen from above.
//!
//! In [`realistic`] the controller flies on what an estimator believes, and the telemetry carries that belief.

pub mod body;
pub mod catalogue;
pub mod conceal;
pub mod controller;
pub mod dopri;
pub mod flight;
pub mod hidden;
pub mod mission;
pub mod path;
pub mod realistic;
pub mod rotors;
pub mod telemetry;
pub mod vehicle;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

/// m/s^2
pub const GRAVITY: f64 = 9.81;

/// kg/m^3
pub const AIR_DENSITY: f64 = 1.2;

/// A generator for one purpose of one flight: different purposes never share numbers.
pub fn dice(seed: u64, purpose: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(purpose))
}
