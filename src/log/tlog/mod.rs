//! Telemetry logs (`.tlog`): MAVLink frames with the host's stamps.

mod reader;

pub use reader::TlogReader;
