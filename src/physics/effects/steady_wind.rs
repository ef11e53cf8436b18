//! The air moves at a constant velocity.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Input, Own, Parameter};

documented! {
    /// The air moves with this constant velocity in world axes. The wind acts through every effect that depends on the
    /// airspeed, and does nothing without one.
    #[derive(Debug, Clone, Copy)]
    pub struct SteadyWind;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "north", unit: "m/s", bounds: Bounds::of(-20.0, 20.0) },
    Parameter { name: "west", unit: "m/s", bounds: Bounds::of(-20.0, 20.0) },
    Parameter { name: "up", unit: "m/s", bounds: Bounds::of(-20.0, 20.0) },
];

impl Effect for SteadyWind {
    fn id(&self) -> &'static str {
        "steady_wind"
    }

    fn sentence(&self) -> &'static str {
        "A steady wind blows: the drag is that of the airspeed, not of the speed over ground."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Air]
    }

    fn wind_m_s(&self, _input: &Input, own: &Own) -> Vector3<f64> {
        own.axes()
    }
}
