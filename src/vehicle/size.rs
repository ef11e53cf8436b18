//! How heavy and how wide a vehicle is.

use super::description::Vehicle;

/// Mass and reach of a vehicle: what the forces, torques and inertias that it can have go with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleSize {
    /// kg
    pub mass_kg: f64,
    /// mean distance of the hubs from the vertical axis through the centre of mass, m; at least the rotors' radius
    pub arm_m: f64,
}

/// No vehicle is smaller, m: a size of zero would leave a bound no width.
const LEAST_ARM_M: f64 = 0.01;

impl Vehicle {
    /// Mass and reach as the vehicle's file states them.
    #[must_use]
    pub fn size(&self) -> VehicleSize {
        let center = self.body.center_of_mass_m.xy();
        let sum_m: f64 = self.rotors.iter().map(|rotor| (rotor.position_m.xy() - center).norm()).sum();
        let mean_m = sum_m / self.rotors.len().max(1) as f64;
        let radius_m = self.propulsion.rotor_radius_m.unwrap_or(0.0);
        VehicleSize { mass_kg: self.body.mass_kg, arm_m: mean_m.max(radius_m).max(LEAST_ARM_M) }
    }
}
