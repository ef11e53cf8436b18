//! Flights that never happened: integration, the paper's closed loop, and synthetic identification
//! flights as an autopilot would log them. Never sees an estimate.

mod allocation;
mod capacity;
mod cascade;
mod controller;
mod divergence;
mod error;
mod flight;
mod ground;
pub mod integrator;
mod logger;
pub mod pid;
mod plant;
mod reference;
mod sensors;
mod setting;
mod shaper;
mod vehicles;

pub use allocation::Allocation;
pub use capacity::PLANT_STATES;
pub use cascade::{AutopilotCascade, AutopilotGains, InnerLoopSetpoint, LoopGains};
pub use controller::{CascadeController, CascadeGains, Setpoint};
pub use error::SimulateError;
pub use flight::{Disturbance, FlightSettings, SimulatedFlight, Truth, simulate_flight};
pub use ground::{GroundContact, GroundSettings};
pub use plant::{Plant, PlantMemory, Push};
pub use reference::{RandomTrajectory, Reference};
pub use sensors::{NoiseLevels, StreamSkew, TelemetryRates, TelemetrySettings};
pub use shaper::{GuidedTarget, Shaper, ShaperLaw, ShaperLimits, Wish, jerk_within};
pub use vehicles::{VehiclePair, random_vehicle};
