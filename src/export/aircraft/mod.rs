//! What follows from a model for the aircraft itself: parameters of its autopilot, each with its error and its reason. What
//! was not identified has no parameter.

mod determined;
mod drag;
mod geometry;
mod parameter;
mod table;
mod thrust;
mod write;

pub use parameter::{AircraftParameter, AircraftParameters};
pub use write::aircraft_parameters;
