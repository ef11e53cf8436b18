//! Flights that never happened: integration, the paper's closed loop, and synthetic identification
//! flights as an autopilot would log them. Never sees an estimate.

mod allocation;
mod cascade;
mod controller;
mod flight;
mod ground;
pub mod integrator;
mod logger;
pub mod pid;
mod plant;
mod reference;
mod sensors;
mod shaper;
mod vehicles;

pub use allocation::Allocation;
pub use cascade::{AutopilotCascade, AutopilotGains, LoopGains, Wanted};
pub use controller::{CascadeController, CascadeGains, Setpoint};
pub use flight::{Disturbance, FlightSettings, SimulatedFlight, Truth, simulate_flight};
pub use ground::{GroundContact, GroundSettings};
pub use plant::{PLANT_STATES, Plant, PlantMemory, Push};
pub use reference::{RandomTrajectory, Reference};
pub use sensors::{NoiseLevels, StreamSkew, TelemetryRates, TelemetrySettings};
pub use shaper::{GuidedTarget, Shaper, ShaperLaw, ShaperLimits, Wish, jerk_within};
pub use vehicles::{VehiclePair, random_vehicle};

use std::time::Duration;

use crate::physics::PhysicsError;

/// Why a simulation could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// the vehicle is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// a setting out of range
    #[error("{name} must be {expected}, got {value}")]
    Setting {
        /// which
        name: &'static str,
        /// the range
        expected: &'static str,
        /// what came
        value: f64,
    },
    /// more own states than the fixed capacity
    #[error("the effects need {count} own states, at most {} fit", PLANT_STATES - crate::physics::RIGID_STATES)]
    TooManyStates {
        /// what they need
        count: usize,
    },
    /// the rotors cannot produce independent thrust and torques
    #[error(
        "the mixer of {rotors} rotors has no right inverse: thrust and three torques are not independent"
    )]
    Allocation {
        /// how many rotors
        rotors: usize,
    },
    /// the state left every bound
    #[error("the simulation left all bounds at {time_s:.3} s: {what}")]
    Diverged {
        /// s
        time_s: f64,
        /// which quantity
        what: &'static str,
    },
    /// adaptive step below its least size
    #[error("the step fell below {least_s:e} s at {time_s} s: the tolerance cannot be met")]
    StepTooSmall {
        /// s
        time_s: f64,
        /// s
        least_s: f64,
    },
}

/// Farther from the reference, or from the origin, the flight is lost: crashed, or an unstable loop.
const LOST_M: f64 = 100.0;

/// A setting that must be positive and finite.
fn positive(name: &'static str, value: f64) -> Result<f64, SimulateError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulateError::Setting { name, expected: "positive and finite", value })
    }
}

/// A setting that must be zero or above, and finite.
fn not_negative(name: &'static str, value: f64) -> Result<f64, SimulateError> {
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulateError::Setting { name, expected: "zero or above and finite", value })
    }
}

/// A time (s) as the nearest number of steps (s).
fn whole_steps(name: &'static str, time_s: f64, step_s: f64) -> Result<usize, SimulateError> {
    let expected = "at least 0 and step_s at least 1 ns, and their ratio a count that fits";
    let failed = || SimulateError::Setting { name, expected, value: time_s };
    let nanoseconds =
        |seconds| Duration::try_from_secs_f64(seconds).map(|d| d.as_nanos()).map_err(|_| failed());
    let (time, step) = (nanoseconds(time_s)?, nanoseconds(step_s)?);
    let steps = (time + step / 2).checked_div(step).ok_or_else(failed)?;
    usize::try_from(steps).map_err(|_| failed())
}
