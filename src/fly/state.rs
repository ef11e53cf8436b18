//! What the vehicle said last: values with the time at which they came.

use std::time::Duration;

use nalgebra::Vector3;

/// A value with when it arrived, on the flight's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timestamped<T> {
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

/// MAV_STATE values at which a failsafe was triggered, whatever it does: critical, emergency.
const TRIGGERED: [u8; 2] = [5, 6];
/// And at which the motors are stopped, by a kill switch too.
const TERMINATION: u8 = 8;

impl FlightState {
    /// The autopilot declares a failsafe. It may have changed its mode for it, or do nothing.
    #[must_use]
    pub fn is_in_failsafe(&self) -> bool {
        TRIGGERED.contains(&self.system_status)
    }

    /// The autopilot declares that the flight is terminated.
    #[must_use]
    pub fn is_terminated(&self) -> bool {
        self.system_status == TERMINATION
    }
}
