//! What comes from outside at one instant.

use nalgebra::Vector3;

use super::{Airframe, MAX_ROTORS};

/// What comes from outside at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// s
    pub time_s: f64,
    /// rotor speed commanded, over the hover speed (-)
    pub speed_command: [f64; MAX_ROTORS],
    /// its rate, 1/s, where the speeds are measured ones; commands step, and have none
    pub speed_rate_1_s: [f64; MAX_ROTORS],
    /// world, m/s
    pub wind_m_s: Vector3<f64>,
    /// V, where known
    pub battery_voltage_v: Option<f64>,
}

impl Input {
    /// Commands u in 0..1, no wind. Commands beyond the rotor count are ignored.
    #[must_use]
    pub fn from_commands(airframe: &Airframe, time_s: f64, commands: &[f64]) -> Self {
        let mut speed_command = [0.0; MAX_ROTORS];
        for (speed, command) in speed_command.iter_mut().zip(commands).take(airframe.rotor_count()) {
            *speed = airframe.relative_speed(*command);
        }
        let speed_rate_1_s = [0.0; MAX_ROTORS];
        Self { time_s, speed_command, speed_rate_1_s, wind_m_s: Vector3::zeros(), battery_voltage_v: None }
    }
}
