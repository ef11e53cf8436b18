//! Telemetry logs (`.tlog`): MAVLink frames with the host's stamps.

mod flown;
mod format;
mod reader;
mod report;
mod survey;
mod walk;

pub(super) use format::FORMAT;
pub use reader::TlogReader;
pub use report::{Resync, TlogReport};
