//! One setpoint, and the message that carries it.

use mavlink::dialects::ardupilotmega::{
    MavFrame, MavMessage, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use nalgebra::Vector3;
use std::f32::consts::PI;
use std::time::Duration;

use super::target::{OutOfRange, Target, within};
use crate::frames::{World, ned_from_world, yaw_from_ned};

/// Greatest coordinate of a position. MAVLink's definition has no range. Further out, a 32-bit float does not resolve a
/// millimetre, and the local frame is not flat to a decimetre.
const POSITION_MAX_M: f32 = 1e4;
/// Greatest speed of a multirotor.
const SPEED_MAX_M_S: f32 = 100.0;
/// Greatest acceleration of a multirotor.
const ACCELERATION_MAX_M_S2: f32 = 100.0;
/// Greatest yaw rate: PX4 accepts at most 1800 deg/s.
const YAW_RATE_MAX_RAD_S: f32 = 32.0;

/// Where the vehicle is to be at one instant, and how it is to move there. World NWU, in the frame of the
/// vehicle's own local position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint {
    /// the instant that it is for, on the flight's clock
    pub time: Duration,
    /// m
    pub position_m: Vector3<f64>,
    /// m/s, feed-forward
    pub velocity_m_s: Vector3<f64>,
    /// m/s^2, feed-forward
    pub acceleration_m_s2: Vector3<f64>,
    /// about up, rad
    pub yaw_rad: f64,
    /// about up, rad/s, feed-forward
    pub yaw_rate_rad_s: f64,
}

impl Setpoint {
    /// To stay at a place.
    #[must_use]
    pub fn hold(time: Duration, place: &Place) -> Self {
        Self {
            time,
            position_m: place.position_m,
            velocity_m_s: Vector3::zeros(),
            acceleration_m_s2: Vector3::zeros(),
            yaw_rad: place.yaw_rad,
            yaw_rate_rad_s: 0.0,
        }
    }

    /// The place of it.
    #[must_use]
    pub fn place(&self) -> Place {
        Place { position_m: self.position_m, yaw_rad: self.yaw_rad }
    }

    /// `SET_POSITION_TARGET_LOCAL_NED` with nothing ignored (mask 0): PX4 and ArduPilot then use position,
    /// velocity, acceleration, yaw and yaw rate together. Converted to NED here.
    ///
    /// # Errors
    /// A value is no number, or further from zero than the greatest that a multirotor has a use for.
    pub fn message(&self, target: Target) -> Result<MavMessage, OutOfRange> {
        let [x, y, z] = ned(self.position_m, "a setpoint's position", "m", POSITION_MAX_M)?;
        let [vx, vy, vz] = ned(self.velocity_m_s, "a setpoint's velocity", "m/s", SPEED_MAX_M_S)?;
        let [afx, afy, afz] =
            ned(self.acceleration_m_s2, "a setpoint's acceleration", "m/s^2", ACCELERATION_MAX_M_S2)?;
        // the same mirror both ways
        let yaw = within("a setpoint's yaw", "rad", wrapped(yaw_from_ned(self.yaw_rad)), -PI..=PI)?;
        let turning = -YAW_RATE_MAX_RAD_S..=YAW_RATE_MAX_RAD_S;
        let yaw_rate = within("a setpoint's yaw rate", "rad/s", yaw_from_ned(self.yaw_rate_rad_s), turning)?;
        Ok(MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            // 32 bits of milliseconds last 49 days of one flight
            time_boot_ms: u32::try_from(self.time.as_millis()).unwrap_or(u32::MAX),
            x,
            y,
            z,
            vx,
            vy,
            vz,
            afx,
            afy,
            afz,
            yaw,
            yaw_rate,
            type_mask: PositionTargetTypemask::empty(),
            target_system: target.system_byte(),
            target_component: target.component.0,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        }))
    }
}

/// A vector in NED, each of whose components is no further from zero than `max`.
fn ned(world: Vector3<f64>, what: &'static str, unit: &str, max: f32) -> Result<[f32; 3], OutOfRange> {
    let [x, y, z] = ned_from_world(World(world)).map(|value| within(what, unit, value, -max..=max));
    Ok([x?, y?, z?])
}

/// Where to stay, world NWU in the frame of the vehicle's local position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// m
    pub position_m: Vector3<f64>,
    /// about up, rad
    pub yaw_rad: f64,
}

/// The same angle within half a turn of zero, rad.
#[must_use]
pub fn wrapped(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle_rad - turn * (angle_rad / turn).round()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{ComponentId, SystemId};

    #[test]
    fn a_setpoint_goes_out_in_ned_with_nothing_ignored() {
        let setpoint = Setpoint {
            time: Duration::from_millis(1500),
            position_m: Vector3::new(1.0, 2.0, 3.0),
            velocity_m_s: Vector3::new(0.1, 0.2, 0.3),
            acceleration_m_s2: Vector3::new(-1.0, 0.0, 2.0),
            yaw_rad: 0.5,
            yaw_rate_rad_s: -0.25,
        };
        let target = Target::new(SystemId(7), ComponentId(1)).unwrap();
        let MavMessage::SET_POSITION_TARGET_LOCAL_NED(data) = setpoint.message(target).unwrap() else {
            panic!()
        };
        assert_eq!((data.x, data.y, data.z), (1.0, -2.0, -3.0));
        assert_eq!((data.vx, data.vy, data.vz), (0.1, -0.2, -0.3));
        assert_eq!((data.afx, data.afy, data.afz), (-1.0, -0.0, -2.0));
        assert_eq!((data.yaw, data.yaw_rate), (-0.5, 0.25));
        assert_eq!(data.type_mask.bits(), 0);
        assert_eq!((data.time_boot_ms, data.target_system, data.target_component), (1500, 7, 1));
    }

    #[test]
    fn yaw_is_sent_within_half_a_turn() {
        for turns in [-3.0, 0.0, 2.0] {
            let angle = wrapped(0.4 + turns * std::f64::consts::TAU);
            assert!((angle - 0.4).abs() < 1e-12);
        }
    }
}
