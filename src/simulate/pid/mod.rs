//! The paper's closed loop, section IV-A: its PID, its sampling, its saturations, force and torque
//! applied directly.

mod control;
mod flight;
mod log;
#[cfg(test)]
mod tests;

pub use control::{Feedback, Pid, PidGains, PidSettings, tilt_of_force};
pub use flight::{Path, PidFlight, PidFlightSettings, simulate_pid_flight, simulate_pid_model_flight};
pub use log::SOURCE;
