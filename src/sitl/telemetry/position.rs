//! Position, velocity, targets and home.

use mavlink::dialects::ardupilotmega::{
    ALTITUDE_DATA, GLOBAL_POSITION_INT_DATA, GPS_GLOBAL_ORIGIN_DATA, GPS_RAW_INT_DATA, GpsFixType,
    HOME_POSITION_DATA, LOCAL_POSITION_NED_DATA, MavEstimatorType, MavFrame, ODOMETRY_DATA,
    POSITION_TARGET_LOCAL_NED_DATA, PositionTargetTypemask, VFR_HUD_DATA,
};
use nalgebra::Vector3;

use super::super::Origin;
use super::super::demand::{frd, ned};
use super::super::guidance::Task;
use super::super::message::Message;
use super::field::{short, ushort};
use super::scene::Scene;
use super::source::Telemetry;
use crate::frames::{Attitude, frd_ned_from_attitude, yaw_from_ned};
use crate::units::{narrow, whole};

/// Degrees north and east (times 1e7) and height above sea (mm) of a place in the local frame.
fn on_earth(origin: &Origin, position_m: &Vector3<f64>) -> [i32; 3] {
    let place = origin.place().moved([position_m.x, position_m.y]);
    let height_m = origin.altitude_m + position_m.z;
    [whole(place.latitude_deg * 1e7), whole(place.longitude_deg * 1e7), whole(height_m * 1e3)]
}

/// Heading clockwise from north, degrees in 0..360.
fn heading_deg(scene: &Scene) -> f64 {
    yaw_from_ned(scene.measured.attitude.euler_angles().2).to_degrees().rem_euclid(360.0)
}

impl Telemetry {
    pub(super) fn local_position_ned(&self, scene: &Scene) -> Message {
        let [x, y, z] = ned(scene.measured.position_m).map(narrow);
        let [vx, vy, vz] = ned(scene.measured.velocity_m_s).map(narrow);
        let time_boot_ms = scene.ms(self.skew.position_s);
        Message::from(LOCAL_POSITION_NED_DATA { time_boot_ms, x, y, z, vx, vy, vz })
    }

    /// Position in the local frame, velocity in the body's.
    pub(super) fn odometry(&self, scene: &Scene) -> Message {
        let seen = &scene.measured;
        let variance = |level: f64| {
            let mut upper = [0.0; 21];
            for diagonal in [0, 6, 11] {
                upper[diagonal] = narrow(level * level);
            }
            upper
        };
        let [x, y, z] = ned(seen.position_m).map(narrow);
        let [vx, vy, vz] = frd(seen.body_velocity_m_s()).map(narrow);
        let [rollspeed, pitchspeed, yawspeed] = frd(seen.rates_rad_s).map(narrow);
        Message::from(ODOMETRY_DATA {
            time_usec: scene.us(self.skew.position_s),
            x,
            y,
            z,
            q: frd_ned_from_attitude(Attitude(seen.attitude)).map(narrow),
            vx,
            vy,
            vz,
            rollspeed,
            pitchspeed,
            yawspeed,
            pose_covariance: variance(self.noise.position_m),
            velocity_covariance: variance(self.noise.velocity_m_s),
            frame_id: MavFrame::MAV_FRAME_LOCAL_NED,
            child_frame_id: MavFrame::MAV_FRAME_BODY_FRD,
            reset_counter: scene.autopilot.estimator.reset_counter,
            estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_AUTOPILOT,
            quality: 0,
        })
    }

    pub(super) fn gps_raw_int(&self, scene: &Scene) -> Message {
        let [lat, lon, alt] = on_earth(&self.origin, &scene.measured.position_m);
        Message::from(GPS_RAW_INT_DATA {
            time_usec: scene.us(0.0),
            lat,
            lon,
            alt,
            // dilution times 100
            eph: 70,
            epv: 110,
            vel: ushort(1e2 * scene.measured.velocity_m_s.xy().norm()),
            // not known
            cog: u16::MAX,
            fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX,
            satellites_visible: 14,
            ..GPS_RAW_INT_DATA::DEFAULT
        })
    }

    pub(super) fn global_position_int(&self, scene: &Scene) -> Message {
        let [lat, lon, alt] = on_earth(&self.origin, &scene.measured.position_m);
        let home_m = scene.autopilot.home_m.unwrap_or_else(Vector3::zeros);
        let [vx, vy, vz] = ned(scene.measured.velocity_m_s).map(|value| short(1e2 * value));
        Message::from(GLOBAL_POSITION_INT_DATA {
            time_boot_ms: scene.ms(self.skew.position_s),
            lat,
            lon,
            alt,
            relative_alt: whole(1e3 * (scene.measured.position_m.z - home_m.z)),
            vx,
            vy,
            vz,
            hdg: ushort(1e2 * heading_deg(scene)),
        })
    }

    pub(super) fn gps_global_origin(&self, scene: &Scene) -> Message {
        let [latitude, longitude, altitude] = on_earth(&self.origin, &Vector3::zeros());
        Message::from(GPS_GLOBAL_ORIGIN_DATA { latitude, longitude, altitude, time_usec: scene.us(0.0) })
    }

    pub(super) fn home_position(&self, scene: &Scene) -> Option<Message> {
        let home_m = scene.autopilot.home_m?;
        let [latitude, longitude, altitude] = on_earth(&self.origin, &home_m);
        let [x, y, z] = ned(home_m).map(narrow);
        Some(Message::from(HOME_POSITION_DATA {
            latitude,
            longitude,
            altitude,
            x,
            y,
            z,
            q: [1.0, 0.0, 0.0, 0.0],
            time_usec: scene.us(0.0),
            ..HOME_POSITION_DATA::DEFAULT
        }))
    }

    pub(super) fn altitude(&self, scene: &Scene) -> Message {
        let height_m = scene.measured.position_m.z;
        let home_m = scene.autopilot.home_m.map_or(0.0, |home| home.z);
        let above_sea_m = narrow(self.origin.altitude_m + height_m);
        Message::from(ALTITUDE_DATA {
            time_usec: scene.us(0.0),
            altitude_monotonic: above_sea_m,
            altitude_amsl: above_sea_m,
            altitude_local: narrow(height_m),
            altitude_relative: narrow(height_m - home_m),
            altitude_terrain: f32::NAN,
            bottom_clearance: f32::NAN,
        })
    }

    pub(super) fn vfr_hud(&self, scene: &Scene) -> Message {
        let seen = &scene.measured;
        let speed = narrow(seen.velocity_m_s.xy().norm());
        let throttle = scene.autopilot.cascade.inner_loop_setpoint().thrust_n / scene.autopilot.thrust_max_n;
        let throttle = if scene.autopilot.is_armed() { throttle.clamp(0.0, 1.0) } else { 0.0 };
        Message::from(VFR_HUD_DATA {
            airspeed: speed,
            groundspeed: speed,
            alt: narrow(self.origin.altitude_m + seen.position_m.z),
            climb: narrow(seen.velocity_m_s.z),
            heading: short(heading_deg(scene)),
            throttle: ushort(1e2 * throttle),
        })
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
        let [x, y, z] = ned(position).map(narrow);
        let [vx, vy, vz] = ned(velocity).map(narrow);
        let [afx, afy, afz] = ned(acceleration).map(narrow);
        Message::from(POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms: scene.ms(0.0),
            x,
            y,
            z,
            vx,
            vy,
            vz,
            afx,
            afy,
            afz,
            yaw: yaw.map_or(0.0, |yaw_rad| narrow(yaw_from_ned(yaw_rad))),
            yaw_rate: 0.0,
            type_mask: PositionTargetTypemask::from_bits_retain(mask),
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        })
    }
}
