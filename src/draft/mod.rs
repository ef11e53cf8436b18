//! A first description of a vehicle: from its autopilot's parameters, its mass and size, a flight, and rules of thumb.

mod hover;
mod rules;
mod stated;
mod vehicle;

pub use stated::parameters_of;
pub use vehicle::{Draft, DraftError, Given, actuator_of, draft};
