//! What is known of a vehicle: its body, its rotors, and how actuator values become force.
//!
//! Frame: body FLU, origin at the geometric centre; SI units.

mod propulsion;
mod rotor;

pub use propulsion::{Actuator, Propulsion, PwmRange, ThrustLaw};
pub use rotor::{Mixer, Rotor, Spin};

use nalgebra::{Matrix3, Vector3};

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

/// What sets the scale of the identified parameters: only thrust per mass can come out of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Anchor {
    /// The thrust law is trusted and the mass is identified (the paper).
    #[default]
    Thrust,
    /// The vehicle was weighed and the thrust coefficient is identified.
    Mass,
}

/// Bounds that a trajectory or a flight must keep; `None` where the vehicle's file sets none.
/// Angles in radians, lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(missing_docs, reason = "each name says quantity and unit")]
pub struct Limits {
    pub roll_max_rad: Option<f64>,
    pub pitch_max_rad: Option<f64>,
    pub yaw_max_rad: Option<f64>,
    pub yaw_rate_max_rad_s: Option<f64>,
    pub yaw_acceleration_max_rad_s2: Option<f64>,
    pub x_max_m: Option<f64>,
    pub y_max_m: Option<f64>,
    pub z_min_m: Option<f64>,
    pub z_max_m: Option<f64>,
    /// bound on each of x', y', z' (the paper bounds them one by one)
    pub speed_max_m_s: Option<f64>,
    pub acceleration_max_m_s2: Option<f64>,
    pub vertical_acceleration_min_m_s2: Option<f64>,
    pub vertical_acceleration_max_m_s2: Option<f64>,
    pub thrust_max_n: Option<f64>,
    pub torque_max_nm: Option<f64>,
}

/// A vehicle as its file states it, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    /// name for reports
    pub name: String,
    /// nominal mass and inertia
    pub body: RigidBody,
    /// thrust and torque from actuator values
    pub propulsion: Propulsion,
    /// in the order of the actuator outputs
    pub rotors: Vec<Rotor>,
    /// what `plan` and `fly` must keep
    pub limits: Limits,
    /// what sets the scale
    pub anchor: Anchor,
    /// m/s^2
    pub gravity_m_s2: f64,
}

impl Vehicle {
    /// The map from rotor thrusts to `F = [Fz tau_x tau_y tau_z]` at the centre of mass.
    #[must_use]
    pub fn mixer(&self) -> Mixer {
        Mixer::new(&self.rotors, self.body.center_of_mass_m, self.propulsion.torque_per_thrust_m)
    }
}
