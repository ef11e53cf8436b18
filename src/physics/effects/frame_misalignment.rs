//! The position reference is not level or not aligned.

use nalgebra::{UnitQuaternion, Vector3};

use crate::physics::{Effect, Hook, Measurement, Parameter, State};

/// The reference's axes are turned against the world's by the rotation vector `(x, y, z)`, `p_world = R_e p`
/// and `q_world = q_e q`: position, velocity and attitude are shown in its axes, the inertial unit is not
/// affected.
#[derive(Debug, Clone, Copy)]
pub struct FrameMisalignment;

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "rad", min: -0.2, max: 0.2 },
    Parameter { name: "y", unit: "rad", min: -0.2, max: 0.2 },
    Parameter { name: "z", unit: "rad", min: -0.2, max: 0.2 },
];

impl Effect for FrameMisalignment {
    fn id(&self) -> &'static str {
        "frame_misalignment"
    }

    fn sentence(&self) -> &'static str {
        "The position reference is askew: what it calls level or north is not."
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Sensors]
    }

    fn measure(
        &self,
        _state: &State,
        _angular_acceleration_rad_s2: &Vector3<f64>,
        parameters: &[f64],
        seen: &mut Measurement,
    ) {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from_column_slice(parameters)).inverse();
        seen.state.position_m = turn * seen.state.position_m;
        seen.state.velocity_m_s = turn * seen.state.velocity_m_s;
        seen.state.attitude = turn * seen.state.attitude;
    }
}
