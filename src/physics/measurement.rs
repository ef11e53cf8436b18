//! What sensors show.

use nalgebra::Vector3;

use super::State;

/// The motion as ideal sensors at the centre of mass show it, before any noise; effects of mounting
/// and frames alter it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// position reference, attitude, gyroscopes
    pub state: State,
    /// accelerometer, sensor axes, m/s^2
    pub specific_force_m_s2: Vector3<f64>,
}
