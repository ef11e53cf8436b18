//! A parameter of an effect, and what values of it are plausible on a vehicle of some size.

use crate::vehicle::VehicleSize;

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// name in reports and files
    pub name: &'static str,
    /// SI unit, `-` if none
    pub unit: &'static str,
    /// physically plausible values
    pub bounds: Bounds,
}

/// Name of the parameter that says which rotor, by its place in the vehicle's description from 0. People are told the motor instead.
pub const WHICH_ROTOR: &str = "rotor";

impl Parameter {
    /// It says which rotor.
    #[must_use]
    pub fn is_rotor(&self) -> bool {
        self.name == WHICH_ROTOR
    }
}

/// The size of vehicle for which bounds are written.
pub const REFERENCE_SIZE: VehicleSize = VehicleSize { mass_kg: 1.0, arm_m: 0.15 };

/// Least and greatest plausible value of a parameter.
///
/// Both are written for a vehicle of [`REFERENCE_SIZE`] and scale with powers of mass and arm. Dimensional analysis
/// gives the powers, with gravity and the speed of a blade's tip the same for all vehicles: a force is a share of the
/// weight `m g`, a drag that share at a speed, `m g / v`, a torque acts at an arm, `m g l`, damping of rotation is drag
/// at hubs that move with `w l` on arms, `m g l^2 / v`, and an inertia is `m l^2`. What the environment or the sampling
/// sets (wind, heights, lengths of lines, times) scales with neither.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    least: f64,
    greatest: f64,
    mass_power: i32,
    arm_power: i32,
}

impl Bounds {
    /// The same for every vehicle, in the parameter's unit.
    #[must_use]
    pub const fn of(least: f64, greatest: f64) -> Self {
        Self { least, greatest, mass_power: 0, arm_power: 0 }
    }

    /// In proportion to the mass.
    #[must_use]
    pub const fn by_mass(self) -> Self {
        Self { mass_power: 1, ..self }
    }

    /// In proportion to this power of the arm.
    #[must_use]
    pub const fn by_arm(self, power: i32) -> Self {
        Self { arm_power: power, ..self }
    }

    /// Least and greatest value on a vehicle of this size, in the parameter's unit.
    #[must_use]
    pub fn at(&self, size: &VehicleSize) -> (f64, f64) {
        let times = (size.mass_kg / REFERENCE_SIZE.mass_kg).powi(self.mass_power)
            * (size.arm_m / REFERENCE_SIZE.arm_m).powi(self.arm_power);
        (self.least * times, self.greatest * times)
    }

    /// Powers of mass and arm with which the bounds scale.
    #[must_use]
    pub const fn powers(&self) -> (i32, i32) {
        (self.mass_power, self.arm_power)
    }
}
