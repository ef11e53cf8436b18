//! What is known of a vehicle: its body, its rotors, and how actuator values become force.
//!
//! Frame: body FLU, origin at the geometric centre; SI units.

mod anchor;
mod body;
mod description;
mod guess;
mod limits;
mod plausible;
mod propulsion;
mod rotor;
mod size;

pub use anchor::Anchor;
pub use body::{AXIS_NAMES, RigidBody, gyroscopic_torque_nm};
pub use description::Vehicle;
pub use guess::{Guess, Guessed};
pub use limits::Limits;
pub use propulsion::{Actuator, Propulsion, PwmRange, ThrustLaw};
pub use rotor::{Mixer, Rotor, Spin, direction_words};
pub use size::VehicleSize;
