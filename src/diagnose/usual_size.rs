//! The size that an effect has on ordinary vehicles.

use crate::vehicle::Vehicle;

/// A parameter's value on an ordinary vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UsualSize {
    /// on every vehicle, in the parameter's unit
    Of(f64),
    /// per kg of the vehicle
    PerMass(f64),
    /// per kg m^2, of the mean of Ixx and Iyy
    PerInertia(f64),
}

impl UsualSize {
    /// In the parameter's unit, on this vehicle.
    #[must_use]
    pub fn on(self, vehicle: &Vehicle) -> f64 {
        let inertia = vehicle.body.inertia_kg_m2;
        match self {
            Self::Of(value) => value,
            Self::PerMass(per) => per * vehicle.body.mass_kg,
            Self::PerInertia(per) => per * 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
        }
    }
}
