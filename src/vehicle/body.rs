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
    /// share of the gyroscopic torque `w x J w` that acts: 1 of every body, another one only of simulators that leave it out
    pub gyroscopic: f64,
}

impl RigidBody {
    /// Torque that a motion takes, `J w' + w x J w`, N m, body: of body rates, rad/s, and their derivative, rad/s^2.
    #[must_use]
    #[inline]
    pub fn turning_torque_nm(&self, rates: &Vector3<f64>, turning: &Vector3<f64>) -> Vector3<f64> {
        self.inertia_kg_m2 * turning + self.gyroscopic_torque_nm(rates)
    }

    /// The gyroscopic part of it, N m, body.
    #[must_use]
    #[inline]
    pub fn gyroscopic_torque_nm(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        gyroscopic_torque_nm(self.gyroscopic, &self.inertia_kg_m2, rates)
    }
}

/// A share of `w x J w`, N m, body: of an inertia, kg m^2, and body rates, rad/s.
#[must_use]
#[inline]
pub fn gyroscopic_torque_nm(share: f64, inertia_kg_m2: &Matrix3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
    rates.cross(&(inertia_kg_m2 * rates)) * share
}
