//! The air moves at a constant velocity.

use nalgebra::Vector3;

use crate::physics::{Bounds, Effect, Hook, Input, Own, Parameter};

/// Wind in the world frame; it acts through whatever depends on airspeed and does nothing without it.
#[derive(Debug, Clone, Copy)]
pub struct SteadyWind;

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
