//! A model for the simulators people use, and for the autopilot of the aircraft itself.
//!
//! Signs, frames and units are converted here and nowhere else: body forward-left-up becomes
//! forward-right-down for PX4 and ArduPilot. What a simulator has no place for is told, never dropped in
//! silence.

mod aircraft;
mod ardupilot;
mod axes;
mod callback;
mod cost;
mod drag;
mod error;
mod format;
mod mjcf;
mod notes;
mod places;
mod program;
mod px4;
mod rotorpy;
mod sdf;
mod source;

pub use aircraft::{AircraftParameter, AircraftParameters, aircraft_parameters};
pub use error::ExportError;
pub use format::{Format, export};
pub use places::{PLACES, places};
pub use program::EffectsProgram;
pub use source::Exported;
