//! A log to share: without positions on the Earth, serial numbers and keys.

mod dataflash;
mod error;
mod names;
mod pass;
mod redaction;
mod texts;
mod tlog;
mod ulog;

pub use error::RedactError;
pub use pass::{Counts, Tally};
pub use redaction::{Redacted, redact};
