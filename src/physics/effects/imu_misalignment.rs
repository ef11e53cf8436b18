//! The inertial unit sits askew.

use nalgebra::{UnitQuaternion, Vector3};

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Measurement, Parameter, State};

documented! {
    /// Accelerometer and gyroscopes measure body vectors turned by the rotation vector `(x, y, z)`. Position and attitude
    /// are not affected.
    #[derive(Debug, Clone, Copy)]
    pub struct ImuMisalignment;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
    Parameter { name: "y", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
    Parameter { name: "z", unit: "rad", bounds: Bounds::of(-0.2, 0.2) },
];

impl Effect for ImuMisalignment {
    fn id(&self) -> &'static str {
        "imu_misalignment"
    }

    fn sentence(&self) -> &'static str {
        "The inertial unit is misaligned: its axes are not those of the body."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
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
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from_column_slice(parameters));
        seen.specific_force_m_s2 = turn * seen.specific_force_m_s2;
        seen.state.rates_rad_s = turn * seen.state.rates_rad_s;
    }
}
