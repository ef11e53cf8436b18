//! A log to share: without positions on the Earth, serial numbers and keys.

mod dataflash;
mod error;
mod names;
mod pass;
mod redact;
mod tlog;
mod ulog;

pub use error::RedactError;
pub use pass::Tally;
pub use redact::{Redacted, redact};
