//! What the vehicle says of itself: noise, stamps and units of each message, world NED and body FRD.

mod actuators;
mod field;
mod motion;
mod position;
mod scene;
mod selection;
mod source;
mod status;

pub(super) use scene::Snapshot;
pub(super) use source::Telemetry;
pub(super) use status::PROTOCOL;
