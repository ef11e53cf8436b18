//! The example of a review service.

#![allow(clippy::unwrap_used, dead_code, reason = "an example has a main function")]

#[path = "../../examples/flight_review/main.rs"]
mod main;

pub use main::diagnostics;
pub(crate) use main::service::Severity;
