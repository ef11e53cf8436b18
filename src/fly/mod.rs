//! The ground station's side of an identification flight.
//!
//! Everything here is pure: values and state machines that are driven by frames and a clock. Times are
//! [`std::time::Duration`]s of the host's monotonic clock since any fixed start.

mod address;
pub mod finding;
pub mod live;
pub mod parameters;
pub mod preflight;
pub mod requests;
pub mod view;
