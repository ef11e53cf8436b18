//! The position reference is not level or not aligned.

use nalgebra::{UnitQuaternion, Vector3};

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Measurement, Parameter, State};

documented! {
    /// The axes of the reference are turned against those of the world by the rotation vector `(x, y, z)`:
    /// `p_world = R_e p` and `q_world = q_e q`. Position, velocity and attitude are given in its axes. The inertial unit
    /// is not affected. In the finer form, only the share `with_attitude` of the rotation vector turns the attitude. The
    /// share is zero for a vehicle that estimates its attitude alone and takes only its position from outside.
    #[derive(Debug, Clone, Copy)]
    pub struct FrameMisalignment;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
    Parameter { name: "y", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
    Parameter { name: "z", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
];

const FINER: &[Parameter] = &[Parameter { name: "with_attitude", unit: "-", bounds: Bounds::of(0.0, 1.0) }];

impl Effect for FrameMisalignment {
    fn id(&self) -> &'static str {
        "frame_misalignment"
    }

    fn sentence(&self) -> &'static str {
        "The position reference is misaligned: its horizontal plane or its north is wrong."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn finer_parameters(&self) -> &'static [Parameter] {
        FINER
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
        let (axes, share) = parameters.split_at(PARAMETERS.len().min(parameters.len()));
        let angles = -Vector3::from_column_slice(axes);
        let turn = UnitQuaternion::from_scaled_axis(angles);
        seen.state.position_m = turn * seen.state.position_m;
        seen.state.velocity_m_s = turn * seen.state.velocity_m_s;
        let of_attitude = share.first().copied().unwrap_or(1.0);
        seen.state.attitude = UnitQuaternion::from_scaled_axis(angles * of_attitude) * seen.state.attitude;
    }
}
