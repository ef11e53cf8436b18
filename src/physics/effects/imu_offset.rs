//! The accelerometer is not at the centre of mass.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Measurement, Parameter, State};

documented! {
    /// `a = a_com + w' x r + w x (w x r)` for an accelerometer at `r = (x, y, z)` from the centre of mass.
    #[derive(Debug, Clone, Copy)]
    pub struct ImuOffset;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "x", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
    Parameter { name: "y", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
    Parameter { name: "z", unit: "m", bounds: Bounds::of(-0.1, 0.1).by_arm(1) },
];

impl Effect for ImuOffset {
    fn id(&self) -> &'static str {
        "imu_offset"
    }

    fn sentence(&self) -> &'static str {
        "The accelerometer is away from the centre of mass: it measures the acceleration of the rotation as well."
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
        state: &State,
        angular_acceleration_rad_s2: &Vector3<f64>,
        parameters: &[f64],
        seen: &mut Measurement,
    ) {
        let arm_m = Vector3::from_column_slice(parameters);
        let w = &state.rates_rad_s;
        seen.specific_force_m_s2 += angular_acceleration_rad_s2.cross(&arm_m) + w.cross(&w.cross(&arm_m));
    }
}
