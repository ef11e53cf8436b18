//! The axes of the simulators.

use nalgebra::Vector3;

/// Body forward-left-up to forward-right-down.
pub(super) fn frd(v: &Vector3<f64>) -> [f64; 3] {
    // no minus zero
    [v.x, 0.0 - v.y, 0.0 - v.z]
}
