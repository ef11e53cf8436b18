//! What the logs hold of one instant, in their frames.

use nalgebra::Vector3;

use super::frames::{quaternion, turned};
use crate::physics::{MAX_ROTORS, State};
use crate::sitl::autopilot::Autopilot;
use crate::sitl::{Mode, Origin};

/// One instant, world north-east-down, body forward-right-down.
#[derive(Debug, Clone)]
pub(super) struct Moment {
    /// microseconds since boot
    pub(super) time_us: f64,
    /// week and milliseconds of it, as satellites count
    pub(super) gps_time: [f64; 2],
    /// of the mean of both sensors, microseconds
    pub(super) period_us: f64,
    pub(super) armed: bool,
    pub(super) landed: bool,
    pub(super) mode: Mode,
    /// w, x, y, z
    pub(super) attitude: [f64; 4],
    pub(super) rates_rad_s: [f64; 3],
    pub(super) force_m_s2: [f64; 3],
    /// over the period that ends now
    pub(super) mean_rates_rad_s: [f64; 3],
    pub(super) mean_force_m_s2: [f64; 3],
    pub(super) position_m: [f64; 3],
    pub(super) velocity_m_s: [f64; 3],
    /// degrees north and east, metres above the sea
    pub(super) on_earth: [f64; 3],
    /// the estimate of the position has an origin
    pub(super) has_origin: bool,
    /// jumps of the estimate so far
    pub(super) resets: f64,
    pub(super) attitude_wanted: [f64; 4],
    pub(super) rates_wanted_rad_s: [f64; 3],
    pub(super) thrust_wanted: f64,
    pub(super) position_wanted_m: [f64; 3],
    pub(super) velocity_wanted_m_s: [f64; 3],
    pub(super) acceleration_wanted_m_s2: [f64; 3],
    pub(super) yaw_wanted_rad: f64,
    pub(super) pulses_us: [u16; MAX_ROTORS],
    /// thrust of each motor over its greatest (-)
    pub(super) motors: [f64; MAX_ROTORS],
    /// that of the rotors together, as shares (-)
    pub(super) torque: [f64; 3],
    pub(super) thrust: f64,
    pub(super) rotor_count: usize,
    /// where the speed controllers tell it
    pub(super) rotor_speed_rad_s: Option<[f64; MAX_ROTORS]>,
    pub(super) battery_v: f64,
}

/// What sensors show at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct SensorReading {
    pub(super) state: State,
    pub(super) force_m_s2: Vector3<f64>,
}

impl Moment {
    /// What the autopilot knows; outputs and means are filled in by who knows them.
    pub(super) fn of(autopilot: &Autopilot, seen: &SensorReading, time_us: f64, origin: &Origin) -> Self {
        let (wanted, setpoint) = (autopilot.cascade.inner_loop_setpoint(), &autopilot.setpoint);
        let position_m = seen.state.position_m;
        let place = origin.place().moved([position_m.x, position_m.y]);
        let [rates_rad_s, force_m_s2] = [turned(&seen.state.rates_rad_s), turned(&seen.force_m_s2)];
        Self {
            time_us,
            gps_time: [0.0; 2],
            period_us: 0.0,
            armed: autopilot.is_armed(),
            landed: autopilot.is_landed(),
            mode: autopilot.mode,
            attitude: quaternion(&seen.state.attitude),
            rates_rad_s,
            force_m_s2,
            mean_rates_rad_s: rates_rad_s,
            mean_force_m_s2: force_m_s2,
            position_m: turned(&position_m),
            velocity_m_s: turned(&seen.state.velocity_m_s),
            on_earth: [place.latitude_deg, place.longitude_deg, origin.altitude_m + position_m.z],
            has_origin: false,
            resets: f64::from(autopilot.estimator.reset_counter),
            attitude_wanted: quaternion(&wanted.attitude),
            rates_wanted_rad_s: turned(&wanted.rates_rad_s),
            thrust_wanted: (wanted.thrust_n / autopilot.thrust_max_n).clamp(0.0, 1.0),
            position_wanted_m: turned(&setpoint.position_m),
            velocity_wanted_m_s: turned(&setpoint.velocity_m_s),
            acceleration_wanted_m_s2: turned(&setpoint.acceleration_m_s2),
            yaw_wanted_rad: -setpoint.yaw_rad,
            pulses_us: [0; MAX_ROTORS],
            motors: [0.0; MAX_ROTORS],
            torque: [0.0; 3],
            thrust: 0.0,
            rotor_count: 0,
            rotor_speed_rad_s: None,
            battery_v: autopilot.battery.volts(),
        }
    }
}
