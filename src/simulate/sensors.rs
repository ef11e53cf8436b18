//! What an autopilot's sensors and log are like: noise, rates, lost samples, stamps.

use nalgebra::{UnitQuaternion, Vector3};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::physics::State;

/// Standard deviation of white noise on each component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseLevels {
    /// m
    pub position_m: f64,
    /// m/s
    pub velocity_m_s: f64,
    /// rad, about each body axis
    pub attitude_rad: f64,
    /// rad/s
    pub rates_rad_s: f64,
    /// m/s^2
    pub specific_force_m_s2: f64,
}

impl Default for NoiseLevels {
    fn default() -> Self {
        Self {
            position_m: 0.004,
            velocity_m_s: 0.015,
            attitude_rad: 1.7e-3,
            rates_rad_s: 6e-3,
            specific_force_m_s2: 0.12,
        }
    }
}

impl NoiseLevels {
    /// All levels times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            position_m: self.position_m * factor,
            velocity_m_s: self.velocity_m_s * factor,
            attitude_rad: self.attitude_rad * factor,
            rates_rad_s: self.rates_rad_s * factor,
            specific_force_m_s2: self.specific_force_m_s2 * factor,
        }
    }

    /// The state as sensors with this noise would give it.
    pub fn measure(&self, rng: &mut Pcg64Mcg, state: &State) -> State {
        let turn = noise(rng) * self.attitude_rad;
        State {
            position_m: state.position_m + noise(rng) * self.position_m,
            velocity_m_s: state.velocity_m_s + noise(rng) * self.velocity_m_s,
            attitude: state.attitude * UnitQuaternion::from_scaled_axis(turn),
            rates_rad_s: state.rates_rad_s + noise(rng) * self.rates_rad_s,
        }
    }

    /// The specific force (m/s^2) as an accelerometer with this noise would give it.
    pub fn measure_force(&self, rng: &mut Pcg64Mcg, specific_force_m_s2: &Vector3<f64>) -> Vector3<f64> {
        specific_force_m_s2 + noise(rng) * self.specific_force_m_s2
    }
}

/// White noise of unit standard deviation on three components.
fn noise(rng: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(rng))
}

/// How often each message is logged, Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TelemetryRates {
    /// attitude and body rates
    pub attitude_hz: f64,
    /// specific force and body rates of the inertial unit
    pub imu_hz: f64,
    /// actuator commands
    pub actuator_hz: f64,
    /// position and velocity
    pub position_hz: f64,
    /// rotor speed; `None` where the vehicle does not send it
    pub rotor_speed_hz: Option<f64>,
    /// setpoints
    pub setpoint_hz: f64,
    /// battery voltage
    pub battery_hz: f64,
    /// landed state
    pub landed_hz: f64,
}

impl Default for TelemetryRates {
    fn default() -> Self {
        Self {
            attitude_hz: 125.0,
            imu_hz: 125.0,
            actuator_hz: 125.0,
            position_hz: 50.0,
            rotor_speed_hz: Some(62.5),
            setpoint_hz: 25.0,
            battery_hz: 2.0,
            landed_hz: 1.0,
        }
    }
}

/// How much later than the sample each stream is stamped, s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StreamSkew {
    /// attitude and its rates
    pub attitude_s: f64,
    /// inertial unit
    pub imu_s: f64,
    /// actuator commands
    pub actuator_s: f64,
    /// position and velocity
    pub position_s: f64,
    /// rotor speed
    pub rotor_speed_s: f64,
}

/// What is logged and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TelemetrySettings {
    /// messages per second
    pub rates: TelemetryRates,
    /// noise of the logged streams
    pub noise: NoiseLevels,
    /// factor on all of [`Self::noise`] (-)
    pub noise_scale: f64,
    /// share of the samples that get lost (-)
    pub loss: f64,
    /// lateness of the stamps
    pub skew: StreamSkew,
    /// log what the controller flew on instead of an independent measurement
    pub share_controller_noise: bool,
    /// the vehicle's clock at the start, s; its fraction of a millisecond shows where stamps are floored
    pub clock_offset_s: f64,
}

impl Default for TelemetrySettings {
    fn default() -> Self {
        Self {
            rates: TelemetryRates::default(),
            noise: NoiseLevels::default(),
            noise_scale: 1.0,
            loss: 0.004,
            skew: StreamSkew::default(),
            share_controller_noise: false,
            clock_offset_s: 0.0,
        }
    }
}
