//! Step of an estimate at a reset.
//!
//! PX4 counts every reset of any size: on each takeoff it aligns its heading again, by a few degrees, some 1.5 m above
//! the ground. Only a step that the vehicle follows with a jerk ends a flight.

use std::fmt;

use nalgebra::{UnitQuaternion, Vector3};

use crate::frames::Attitude;

/// Largest time between two samples that show a step, s. Over more, velocity and its error explain any step.
pub(super) const GAP_MAX_S: f64 = 0.5;
/// Largest step of the position with which the flight continues, m. Setpoints that leap by more would throw the
/// vehicle; a smaller limit would end flights at every correction.
const POSITION_MAX_M: f64 = 0.3;
/// Largest step of the velocity with which the flight continues, m/s. More is no correction of a sound estimate.
const VELOCITY_MAX_M_S: f64 = 0.5;
/// Largest step of the attitude with which the flight continues, rad. 20 degrees: more would turn the trajectory in
/// the room.
const TURN_MAX_RAD: f64 = 0.35;
/// Largest acceleration of a vehicle between two samples, m/s^2. More than the tilt of 40 degrees gives; what exceeds
/// it is no motion.
const ACCELERATION_M_S2: f64 = 8.0;

/// The estimate of one instant, world NWU, body FLU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// s of the vehicle's clock
    pub time_s: f64,
    /// m
    pub position_m: Vector3<f64>,
    /// m/s, world
    pub velocity_m_s: Vector3<f64>,
    /// orientation
    pub attitude: Attitude,
    /// rad/s, body
    pub rates_rad_s: Vector3<f64>,
}

/// The part of a reset that the motion does not explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// the samples around it are too far apart, or there is none before it
    Unknown,
    /// m, m/s beyond what a vehicle accelerates, rad
    Known {
        /// m
        position_m: f64,
        /// m/s
        velocity_m_s: f64,
        /// rad
        turn_rad: f64,
    },
}

impl Step {
    /// The step from the last estimate before a reset to the first after it.
    #[must_use]
    pub fn between(before: Option<&Pose>, after: &Pose) -> Self {
        let Some(before) = before else { return Self::Unknown };
        let passed_s = after.time_s - before.time_s;
        if !(0.0..GAP_MAX_S).contains(&passed_s) {
            return Self::Unknown;
        }
        let moved = 0.5 * (before.velocity_m_s + after.velocity_m_s) * passed_s;
        let turned = 0.5 * (before.rates_rad_s + after.rates_rad_s) * passed_s;
        let expected = before.attitude.0 * UnitQuaternion::from_scaled_axis(turned);
        let change_m_s = (after.velocity_m_s - before.velocity_m_s).norm();
        // a step of the velocity moves the mean velocity by half of it: that is no step of the position
        Self::Known {
            position_m: (after.position_m - before.position_m - moved).norm(),
            velocity_m_s: (change_m_s - ACCELERATION_M_S2 * passed_s).max(0.0),
            turn_rad: expected.angle_to(&after.attitude.0),
        }
    }

    /// Whether it is small enough to continue the flight.
    #[must_use]
    pub fn is_small(&self) -> bool {
        match self {
            Self::Unknown => false,
            Self::Known { position_m, velocity_m_s, turn_rad } => {
                *position_m <= POSITION_MAX_M
                    && *velocity_m_s <= VELOCITY_MAX_M_S
                    && *turn_rad <= TURN_MAX_RAD
            }
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => write!(f, "by how much is not known"),
            Self::Known { position_m, velocity_m_s, turn_rad } => write!(
                f,
                "by {position_m:.2} m, {velocity_m_s:.2} m/s, {:.1} degrees",
                crate::units::deg_from_rad(*turn_rad)
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(time_s: f64, x_m: f64, vx_m_s: f64, yaw_rad: f64) -> Pose {
        Pose {
            time_s,
            position_m: Vector3::new(x_m, 0.0, 1.5),
            velocity_m_s: Vector3::new(vx_m_s, 0.0, 0.9),
            attitude: Attitude(UnitQuaternion::from_euler_angles(0.0, 0.0, yaw_rad)),
            rates_rad_s: Vector3::zeros(),
        }
    }

    #[test]
    fn the_heading_that_is_aligned_after_a_takeoff_is_small() {
        let step = Step::between(Some(&pose(1.0, 0.0, 0.0, 0.03)), &{
            let after = pose(1.05, 0.0, 0.0, -0.03);
            Pose { position_m: after.position_m + Vector3::new(0.0, 0.0, 0.045), ..after }
        });
        let Step::Known { position_m, turn_rad, .. } = step else { panic!("{step}") };
        assert!(position_m < 1e-9 && (turn_rad - 0.06).abs() < 1e-9 && step.is_small(), "{step}");
    }

    #[test]
    fn a_step_that_would_be_followed_is_not() {
        let before = pose(1.0, 0.0, 0.0, 0.0);
        let far = pose(1.05, 0.5, 0.0, 0.0);
        let fast = pose(1.05, 0.0, 1.2, 0.0);
        let turned = pose(1.05, 0.0, 0.0, 0.6);
        for after in [far, fast, turned] {
            let step = Step::between(Some(&before), &after);
            assert!(!step.is_small(), "{step}");
        }
        assert_eq!(Step::between(Some(&before), &pose(1.7, 0.0, 0.0, 0.0)), Step::Unknown);
        assert_eq!(Step::between(None, &before), Step::Unknown);
    }
}
