//! The embedded simulated vehicle: physics of [`crate::simulate`] behind an autopilot that speaks MAVLink 2
//! as PX4 or as ArduPilot does.
//!
//! [`Vehicle`] does no I/O and has no clock of its own ([`serve()`] gives it both): bytes go in with [`Vehicle::receive`], time goes on with
//! [`Vehicle::advance`], and frames with their times come out. The same calls give the same bytes.
//!
//! ```text
//! bytes -> requests, commands, setpoints -> autopilot (modes, failsafes) -> cascade -> outputs
//!                                              ^                                        |
//!                        frames <- telemetry <- noise <- sensors <- plant and effects <-+
//! ```
//!
//! What it does is what both autopilots were seen to do; nothing that it sends tells the simulation's truth.

mod autopilot;
mod battery;
mod commands;
mod craft;
mod demand;
mod estimator;
mod fault;
mod fence;
mod guidance;
mod link;
mod message;
mod mission;
mod modes;
mod parameters;
mod requests;
mod safety;
mod serve;
mod setpoints;
mod settings;
mod streams;
mod telemetry;
mod tuning;
mod vehicle;

pub use fault::Fault;
pub use link::{LinkId, LinkRole};
pub use modes::{ArduPilotRelease, AutopilotKind, Mode};
pub use serve::{LOCKSTEP, Pace, Served, serve};
pub use settings::{Origin, SensorSettings, Settings};
pub use vehicle::{Beheld, Outgoing, Vehicle};

use crate::physics::PhysicsError;
use crate::simulate::SimulateError;

/// Why a vehicle cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SitlError {
    /// the vehicle or an effect is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// the simulation or its controller cannot be set up
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// a setting out of range
    #[error("{name}: expected {expected}, got {got}")]
    Setting {
        /// which
        name: String,
        /// the range
        expected: &'static str,
        /// what came
        got: String,
    },
}
