//! `mavid inspect LOG`: what is in a log and what can be identified from it.
//!
//! The JSON document is `{"schema": 1, "file": ..., ...}` with the fields of
//! [`mavid::inspect::Inspection`]; keys carry their unit, times are seconds of the vehicle's clock from the
//! recording's start, and what is not known is `null`.

mod page;
mod progress;
mod verb;

pub use verb::run;
