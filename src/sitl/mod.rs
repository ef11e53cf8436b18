//! The embedded simulated vehicle: physics of [`crate::simulate`] behind an autopilot that speaks MAVLink 2
//! as PX4 or as ArduPilot does.
//!
//! [`Vehicle`] does no I/O and has no clock of its own ([`serve()`] gives it both): bytes go in with [`Vehicle::receive`], time advances with
//! [`Vehicle::advance`], and frames with their times come out. The same calls give the same bytes.
//!
//! ```text
//! bytes -> requests, commands, setpoints -> autopilot (modes, failsafes) -> cascade -> outputs
//!                                              ^                                        |
//!                        frames <- telemetry <- noise <- sensors <- plant and effects <-+
//! ```
//!
//! What it does is what both autopilots were seen to do; nothing that it sends tells the simulation's truth.

mod action;
mod autopilot;
mod battery;
mod commands;
mod connection;
mod craft;
mod demand;
mod error;
mod estimator;
mod failsafe;
mod fault;
mod fence;
mod files;
mod firmware;
mod guidance;
mod link;
mod logger;
mod message;
mod mission;
mod modes;
mod outgoing;
mod parameters;
mod ping;
mod requests;
mod safety;
mod serve;
mod serving;
mod setpoints;
mod settings;
mod streams;
mod telemetry;
mod texts;
mod tuning;
mod upload;
mod vehicle;

pub use connection::{LinkId, LinkRole};
pub use error::SitlError;
pub use fault::Fault;
pub use firmware::Firmware;
pub use modes::Mode;
pub use outgoing::Outgoing;
pub use serve::{LOCKSTEP, Pace, Served, serve};
pub use settings::{Origin, SensorSettings, Settings};
pub use vehicle::{Beheld, Vehicle};
