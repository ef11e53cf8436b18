//! The distance to stop.

use crate::autopilot::{Braking, PX4};
use crate::fly::parameters::Parameters;
use crate::units::rad_from_deg;
use crate::vehicle::Limits;
use nalgebra::Vector3;

/// Deceleration of the vehicle, m/s^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Stopping {
    /// in the plane
    pub horizontal_m_s2: f64,
    /// up or down
    pub vertical_m_s2: f64,
    /// source of these values
    pub basis: String,
}

/// Assumed deceleration if neither the vehicle file nor the autopilot states one, m/s^2: the usual default of both
/// autopilots.
const ASSUMED_M_S2: f64 = 2.5;

impl Stopping {
    /// Deceleration by the autopilot's own limits, at most that of the tilt limit and the vehicle file.
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

    /// Position at rest if the vehicle begins to brake at a position with a velocity, by `v^2 / 2a`.
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
