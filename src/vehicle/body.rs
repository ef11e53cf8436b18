//! Mass and inertia of a vehicle.

use nalgebra::{Matrix3, Vector3};

/// What the axes of a frame are called.
pub const AXIS_NAMES: [&str; 3] = ["x", "y", "z"];

/// Mass and inertia about the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidBody {
    /// kg
    pub mass_kg: f64,
    /// kg m^2, entries of the symmetric tensor about the centre of mass, body FLU
    pub inertia_kg_m2: Matrix3<f64>,
    /// m, body FLU, from the origin to which rotor positions refer
    pub center_of_mass_m: Vector3<f64>,
}
