//! What the vehicle said last: values with the time at which they came.

use std::time::Duration;

use nalgebra::Vector3;

/// A value with when it arrived, on the flight's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen<T> {
    /// when
    pub at: Duration,
    /// what
    pub value: T,
}

/// Place and motion of one instant, world NWU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// s of the vehicle's clock
    pub time_s: f64,
    /// m
    pub position_m: Vector3<f64>,
    /// m/s
    pub velocity_m_s: Vector3<f64>,
}

/// The vehicle's own flight state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlightState {
    /// HEARTBEAT.custom_mode
    pub custom_mode: u32,
    /// motors may turn
    pub armed: bool,
    /// MAV_STATE
    pub system_status: u8,
}

/// MAV_STATE values at which the autopilot itself has taken measures: critical, emergency, termination.
const MEASURES_TAKEN: [u8; 3] = [5, 6, 8];

impl FlightState {
    /// The autopilot has taken measures of its own.
    #[must_use]
    pub fn is_in_failsafe(&self) -> bool {
        MEASURES_TAKEN.contains(&self.system_status)
    }
}
