//! Typed messages become SI samples in this crate's frames, here and nowhere else.
//!
//! Fields are read straight from the payload by their offset on the wire (largest types first, as MAVLink
//! orders them), so that a value which the dialect's enumerations do not know loses nothing.

mod actuators;
mod decoder;
mod dispatch;
mod imu;
mod motion;
mod report;
mod samples;
mod setpoints;
mod source;
mod status;
mod text;
mod vehicle;

pub use decoder::Decoder;
pub use report::DecodeReport;
pub use source::Source;
pub use text::STATUSTEXT_BYTES;
pub use vehicle::Vehicle;
