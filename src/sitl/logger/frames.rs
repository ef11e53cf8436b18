//! From the simulation's frames (north, west, up; forward, left, up) to those of the logs (north, east, down; forward,
//! right, down).

use nalgebra::{UnitQuaternion, Vector3};

/// A vector of the world or of the body: both have the second and third axis the other way round.
pub(super) fn turned(vector: &Vector3<f64>) -> [f64; 3] {
    [vector.x, -vector.y, -vector.z]
}

/// w, x, y, z of an attitude, with a positive w.
pub(super) fn quaternion(attitude: &UnitQuaternion<f64>) -> [f64; 4] {
    let sign = if attitude.w < 0.0 { -1.0 } else { 1.0 };
    [attitude.w, attitude.i, -attitude.j, -attitude.k].map(|part| sign * part)
}

/// Roll, pitch and yaw of such a quaternion, degrees; yaw in 0 to 360.
pub(super) fn euler_deg([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let roll = (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y));
    let pitch = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin();
    let yaw = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    [roll.to_degrees(), pitch.to_degrees(), yaw.to_degrees().rem_euclid(360.0)]
}
