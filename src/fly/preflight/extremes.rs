//! The largest values along a path, and what it takes to stop on it.

use crate::autopilot::{Braking, PX4};
use crate::fly::parameters::Parameters;
use crate::trajectory::{FlightPath, Reference};
use crate::units::rad_from_deg;
use crate::vehicle::{Limits, Vehicle};
use nalgebra::Vector3;

/// Between samples of a path, s: a tenth of the fastest motion that a multirotor follows.
const SAMPLE_S: f64 = 0.01;

/// Largest values along a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(missing_docs, reason = "each name says quantity and unit")]
pub struct Extremes {
    pub horizontal_speed_m_s: f64,
    pub up_speed_m_s: f64,
    pub down_speed_m_s: f64,
    pub horizontal_acceleration_m_s2: f64,
    pub vertical_acceleration_m_s2: f64,
    pub horizontal_jerk_m_s3: f64,
    pub vertical_jerk_m_s3: f64,
    pub tilt_rad: f64,
    pub yaw_rate_rad_s: f64,
    /// least and greatest x, y, z
    pub low_m: [f64; 3],
    pub high_m: [f64; 3],
}

impl Extremes {
    /// Of a whole path.
    #[must_use]
    pub fn of(path: &FlightPath, vehicle: &Vehicle) -> Self {
        let mut out = Self { low_m: [f64::INFINITY; 3], high_m: [f64::NEG_INFINITY; 3], ..Self::default() };
        for (_, entry) in samples(path) {
            let [x, y, z, yaw] = entry;
            for (axis, place) in [x, y, z].into_iter().enumerate() {
                out.low_m[axis] = out.low_m[axis].min(place[0]);
                out.high_m[axis] = out.high_m[axis].max(place[0]);
            }
            let horizontal = |order: usize| x[order].hypot(y[order]);
            let motion = Reference::new(entry, vehicle.gravity_m_s2).motion;
            out.horizontal_speed_m_s = out.horizontal_speed_m_s.max(horizontal(1));
            out.up_speed_m_s = out.up_speed_m_s.max(z[1]);
            out.down_speed_m_s = out.down_speed_m_s.max(-z[1]);
            out.horizontal_acceleration_m_s2 = out.horizontal_acceleration_m_s2.max(horizontal(2));
            out.vertical_acceleration_m_s2 = out.vertical_acceleration_m_s2.max(z[2].abs());
            out.horizontal_jerk_m_s3 = out.horizontal_jerk_m_s3.max(horizontal(3));
            out.vertical_jerk_m_s3 = out.vertical_jerk_m_s3.max(z[3].abs());
            let tilt = (motion.roll[0].cos() * motion.pitch[0].cos()).acos();
            out.tilt_rad = out.tilt_rad.max(tilt);
            out.yaw_rate_rad_s = out.yaw_rate_rad_s.max(yaw[1].abs());
        }
        out
    }
}

/// Time (s) and entry at equal steps, first and last instant among them.
pub(super) fn samples(path: &FlightPath) -> impl Iterator<Item = (f64, [[f64; 5]; 4])> + '_ {
    let duration_s = path.duration_s();
    let mut step = 0.0;
    let mut done = false;
    std::iter::from_fn(move || {
        if done {
            return None;
        }
        let time_s: f64 = (step * SAMPLE_S).min(duration_s);
        step += 1.0;
        // a path without an end, or of no length, is its first instant
        done = time_s.is_nan() || time_s >= duration_s;
        path.derivatives(time_s).map(|entry| (time_s, entry))
    })
}

/// How hard the vehicle brakes, m/s^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Stopping {
    /// in the plane
    pub horizontal_m_s2: f64,
    /// up or down
    pub vertical_m_s2: f64,
    /// what that rests on
    pub basis: String,
}

/// Where neither the vehicle file nor the autopilot says more: both autopilots' usual default, m/s^2.
const ASSUMED_M_S2: f64 = 2.5;

impl Stopping {
    /// From the autopilot's own limits, no more than tilt and the vehicle file allow.
    #[must_use]
    pub fn of(parameters: &Parameters, limits: &Limits, gravity_m_s2: f64) -> Self {
        let value = |name: &str| parameters.in_base_unit(name).filter(|value| *value > 0.0);
        let Braking { horizontal: name, vertical, tilt } =
            parameters.autopilot.stack().unwrap_or(&PX4).braking;
        let (horizontal, tilt_deg) = (value(name), value(tilt));
        let vertical: Option<Vec<f64>> = vertical.iter().map(|name| value(name)).collect();
        let vertical = vertical.and_then(|values| values.into_iter().reduce(f64::min));
        let basis = match horizontal {
            Some(value) => format!("braking at {value:.1} m/s^2 ({})", parameters.name_of(name)),
            None => format!(
                "braking at {ASSUMED_M_S2} m/s^2, assumed because {} did not answer",
                parameters.name_of(name)
            ),
        };
        let by_tilt = tilt_deg.map_or(f64::INFINITY, |tilt| gravity_m_s2 * rad_from_deg(tilt).tan());
        let by_file = limits.acceleration_max_m_s2.unwrap_or(f64::INFINITY);
        Self {
            horizontal_m_s2: horizontal.unwrap_or(ASSUMED_M_S2).min(by_tilt).min(by_file),
            vertical_m_s2: vertical.unwrap_or(ASSUMED_M_S2).min(by_file),
            basis,
        }
    }

    /// Where the vehicle comes to rest if it begins to brake at a place with a velocity: `v^2 / 2a` on.
    #[must_use]
    pub fn rest(&self, place_m: &Vector3<f64>, velocity_m_s: &Vector3<f64>) -> Vector3<f64> {
        let horizontal = velocity_m_s.xy().norm() / (2.0 * self.horizontal_m_s2);
        let vertical = velocity_m_s.z.abs() / (2.0 * self.vertical_m_s2);
        place_m
            + Vector3::new(
                velocity_m_s.x * horizontal,
                velocity_m_s.y * horizontal,
                velocity_m_s.z * vertical,
            )
    }
}

/// Place and velocity of a path entry, m and m/s.
pub(super) fn place_and_velocity(entry: &[[f64; 5]; 4]) -> (Vector3<f64>, Vector3<f64>) {
    let [x, y, z, _] = entry;
    (Vector3::new(x[0], y[0], z[0]), Vector3::new(x[1], y[1], z[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braking_takes_the_square_of_speed_over_twice_the_deceleration() {
        let stopping = Stopping { horizontal_m_s2: 2.0, vertical_m_s2: 1.0, basis: String::new() };
        let rest = stopping.rest(&Vector3::new(1.0, 1.0, 1.0), &Vector3::new(3.0, 4.0, -2.0));
        // 25 / 4 = 6.25 m along (0.6, 0.8), and 4 / 2 = 2 m down
        assert!((rest - Vector3::new(4.75, 6.0, -1.0)).norm() < 1e-12, "{rest}");
        let resting = stopping.rest(&Vector3::zeros(), &Vector3::zeros());
        assert_eq!(resting, Vector3::zeros());
    }
}
