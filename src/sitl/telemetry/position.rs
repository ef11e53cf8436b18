//! Position, velocity, targets and home.

use nalgebra::Vector3;

use super::super::Origin;
use super::super::demand::{frd, ned};
use super::super::guidance::Task;
use super::super::message::Message;
use super::super::message_id as ids;
use super::field::{short, ushort};
use super::scene::Scene;
use super::source::Telemetry;
use crate::frames::{Attitude, frd_ned_from_attitude, yaw_from_ned};
use crate::units::whole;

/// MAV_FRAME.
const LOCAL_NED: u8 = 1;
const BODY_FRD: u8 = 12;

/// Degrees north and east (times 1e7) and height above sea (mm) of a place in the local frame.
fn on_earth(origin: &Origin, position_m: &Vector3<f64>) -> [i32; 3] {
    let place = origin.place().moved([position_m.x, position_m.y]);
    let height_m = origin.altitude_m + position_m.z;
    [whole(place.latitude_deg * 1e7), whole(place.longitude_deg * 1e7), whole(height_m * 1e3)]
}

/// Heading clockwise from north, degrees in 0..360.
fn heading_deg(scene: &Scene) -> f64 {
    yaw_from_ned(scene.seen.attitude.euler_angles().2).to_degrees().rem_euclid(360.0)
}

impl Telemetry {
    pub(super) fn local_position_ned(&self, scene: &Scene) -> Message {
        Message::new(ids::LOCAL_POSITION_NED)
            .u32(scene.ms(self.skew.position_s))
            .f32s(&ned(scene.seen.position_m))
            .f32s(&ned(scene.seen.velocity_m_s))
    }

    /// Position in the local frame, velocity in the body's.
    pub(super) fn odometry(&self, scene: &Scene) -> Message {
        let seen = &scene.seen;
        let variance = |level: f64| {
            let mut upper = [0.0; 21];
            for diagonal in [0, 6, 11] {
                upper[diagonal] = level * level;
            }
            upper
        };
        Message::new(ids::ODOMETRY)
            .u64(scene.us(self.skew.position_s))
            .f32s(&ned(seen.position_m))
            .f32s(&frd_ned_from_attitude(Attitude(seen.attitude)))
            .f32s(&frd(seen.body_velocity_m_s()))
            .f32s(&frd(seen.rates_rad_s))
            .f32s(&variance(self.noise.position_m))
            .f32s(&variance(self.noise.velocity_m_s))
            .u8(LOCAL_NED)
            .u8(BODY_FRD)
            .u8(scene.autopilot.estimator.reset_counter)
            .u8(8)
            .i8(0)
    }

    pub(super) fn gps_raw_int(&self, scene: &Scene) -> Message {
        let place = on_earth(&self.origin, &scene.seen.position_m);
        let speed = scene.seen.velocity_m_s.xy().norm();
        let message = Message::new(ids::GPS_RAW_INT).u64(scene.us(0.0));
        let message = place.iter().fold(message, |message, value| message.i32(*value));
        // GPS_FIX_TYPE_3D_FIX, dilution times 100, course not known
        message.u16(70).u16(110).u16(ushort(1e2 * speed)).u16(u16::MAX).u8(3).u8(14)
    }

    pub(super) fn global_position_int(&self, scene: &Scene) -> Message {
        let message = Message::new(ids::GLOBAL_POSITION_INT).u32(scene.ms(self.skew.position_s));
        let place = on_earth(&self.origin, &scene.seen.position_m);
        let message = place.iter().fold(message, |message, value| message.i32(*value));
        let home_m = scene.autopilot.home_m.unwrap_or_else(Vector3::zeros);
        let message = message.i32(whole(1e3 * (scene.seen.position_m.z - home_m.z)));
        let velocity = ned(scene.seen.velocity_m_s);
        velocity
            .iter()
            .fold(message, |message, value| message.i16(short(1e2 * value)))
            .u16(ushort(1e2 * heading_deg(scene)))
    }

    pub(super) fn gps_global_origin(&self, scene: &Scene) -> Message {
        let place = on_earth(&self.origin, &Vector3::zeros());
        let message = Message::new(ids::GPS_GLOBAL_ORIGIN);
        place.iter().fold(message, |message, value| message.i32(*value)).u64(scene.us(0.0))
    }

    pub(super) fn home_position(&self, scene: &Scene) -> Option<Message> {
        let home_m = scene.autopilot.home_m?;
        let message = Message::new(ids::HOME_POSITION);
        let place = on_earth(&self.origin, &home_m);
        let message = place.iter().fold(message, |message, value| message.i32(*value));
        Some(message.f32s(&ned(home_m)).f32s(&[1.0, 0.0, 0.0, 0.0]).f32s(&[0.0; 3]).u64(scene.us(0.0)))
    }

    pub(super) fn altitude(&self, scene: &Scene) -> Message {
        let height_m = scene.seen.position_m.z;
        let home_m = scene.autopilot.home_m.map_or(0.0, |home| home.z);
        let above_sea_m = self.origin.altitude_m + height_m;
        Message::new(ids::ALTITUDE).u64(scene.us(0.0)).f32s(&[
            above_sea_m,
            above_sea_m,
            height_m,
            height_m - home_m,
            f64::NAN,
            f64::NAN,
        ])
    }

    pub(super) fn vfr_hud(&self, scene: &Scene) -> Message {
        let seen = &scene.seen;
        let speed = seen.velocity_m_s.xy().norm();
        let throttle = scene.autopilot.cascade.wanted().thrust_n / scene.autopilot.thrust_max_n;
        let throttle = if scene.autopilot.is_armed() { throttle.clamp(0.0, 1.0) } else { 0.0 };
        Message::new(ids::VFR_HUD)
            .f32s(&[speed, speed, self.origin.altitude_m + seen.position_m.z, seen.velocity_m_s.z])
            .i16(short(heading_deg(scene)))
            .u16(ushort(1e2 * throttle))
    }

    /// What was asked for, or where no setpoint is flown what the autopilot asks of itself. ArduPilot does not
    /// mirror yaw.
    pub(super) fn position_target(&self, scene: &Scene) -> Message {
        let own = &scene.autopilot.setpoint;
        let (position, velocity, acceleration, yaw) = match scene.autopilot.guidance.task {
            Task::Direct(demand) => (
                demand.motion.position_m,
                demand.motion.velocity_m_s,
                demand.motion.acceleration_m_s2,
                demand.yaw_rad,
            ),
            Task::Shaped(demand, _) => {
                (demand.motion.position_m, demand.motion.velocity_m_s, demand.motion.acceleration_m_s2, None)
            }
            _ => (own.position_m, own.velocity_m_s, own.acceleration_m_s2, Some(own.yaw_rad)),
        };
        let mut mask = 0;
        for (group, vector) in [position, velocity, acceleration].iter().enumerate() {
            for (axis, value) in vector.iter().enumerate() {
                mask |= u16::from(value.is_nan()) << (3 * group + axis);
            }
        }
        mask |= u16::from(yaw.is_none()) << 10 | 1 << 11;
        Message::new(ids::POSITION_TARGET_LOCAL_NED)
            .u32(scene.ms(0.0))
            .f32s(&ned(position))
            .f32s(&ned(velocity))
            .f32s(&ned(acceleration))
            .f32(yaw.map_or(0.0, yaw_from_ned))
            .f32(0.0)
            .u16(mask)
            .u8(LOCAL_NED)
    }
}
