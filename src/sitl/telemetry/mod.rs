//! What the vehicle says of itself: noise, stamps and units of each message, world NED and body FRD.

mod actuators;
mod motion;
mod position;
mod status;

use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::autopilot::Autopilot;
use super::craft::Shown;
use super::message::Message;
use super::streams as ids;
use super::{AutopilotKind, Origin, Settings};
use crate::log::EMBEDDED_UID2;
use crate::physics::{MAX_ROTORS, State};
use crate::simulate::{NoiseLevels, StreamSkew};

/// Keeps the telemetry's noise apart from the autopilot's.
const TELEMETRY_SEED: u64 = 0x7465_6c65_6d65_7472;

/// What the vehicle does at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Snapshot {
    /// since boot
    pub(super) now: Duration,
    pub(super) shown: Shown,
    /// pulses that are put out, microseconds
    pub(super) pulses_us: [u16; MAX_ROTORS],
}

/// Makes messages.
#[derive(Debug)]
pub(super) struct Telemetry {
    kind: AutopilotKind,
    noise: NoiseLevels,
    skew: StreamSkew,
    rng: Pcg64Mcg,
    origin: Origin,
    rotor_count: usize,
    esc_telemetry: bool,
    uid2: [u8; EMBEDDED_UID2.len()],
    pub(super) boot_unix_us: u64,
    pings: u32,
}

/// One message in the making.
struct Scene<'a> {
    at: &'a Snapshot,
    autopilot: &'a Autopilot,
    /// what sensors show of the motion, with noise
    seen: State,
}

impl Telemetry {
    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            kind: settings.autopilot,
            noise: settings.sensors.noise.scaled(settings.sensors.noise_scale),
            skew: settings.sensors.skew,
            rng: Pcg64Mcg::seed_from_u64(settings.seed ^ TELEMETRY_SEED),
            origin: settings.origin,
            rotor_count: settings.vehicle.rotors.len(),
            esc_telemetry: settings.esc_telemetry,
            uid2: settings.nonce.map_or(EMBEDDED_UID2, |nonce| nonce.uid2()),
            boot_unix_us: settings.boot_unix_us,
            pings: 0,
        }
    }

    /// A number in 0..1 that decides whether a frame gets lost.
    pub(super) fn chance(&mut self) -> f64 {
        self.rng.random()
    }

    /// The message of this id as it is now; `None` where the vehicle has nothing to say.
    pub(super) fn message(&mut self, id: u32, at: &Snapshot, autopilot: &Autopilot) -> Option<Message> {
        let mut seen = self.noise.measure(&mut self.rng, &at.shown.state);
        seen.position_m += autopilot.estimator.shift_m();
        let scene = Scene { at, autopilot, seen };
        let has_origin = autopilot.estimator.is_warm(at.now);
        Some(match id {
            ids::HEARTBEAT => self.heartbeat(&scene),
            ids::SYS_STATUS => self.sys_status(&scene),
            ids::SYSTEM_TIME => self.system_time(&scene),
            ids::PING => self.ping(&scene),
            ids::LINK_NODE_STATUS => self.link_node_status(&scene),
            ids::BATTERY_STATUS => self.battery_status(&scene),
            ids::AUTOPILOT_VERSION => self.autopilot_version(),
            ids::EXTENDED_SYS_STATE => self.extended_sys_state(&scene),
            ids::CURRENT_MODE => self.current_mode(&scene),
            ids::CURRENT_EVENT_SEQUENCE => Message::foreign(id, 106).u16(0).u8(0),
            ids::TIMESYNC => timesync(0, nanoseconds(at.now)),
            ids::ESTIMATOR_STATUS | ids::EKF_STATUS_REPORT => self.estimator_status(id, &scene),
            ids::RC_CHANNELS if autopilot.safety.has_transmitter() => self.rc_channels(&scene),
            ids::ATTITUDE => self.attitude(&scene),
            ids::ATTITUDE_QUATERNION => self.attitude_quaternion(&scene),
            ids::ATTITUDE_TARGET if autopilot.is_armed() => self.attitude_target(&scene),
            ids::HIGHRES_IMU => self.highres_imu(&scene),
            ids::RAW_IMU | ids::SCALED_IMU2 => self.raw_imu(id, &scene),
            ids::SERVO_OUTPUT_RAW => self.servo_output_raw(&scene),
            ids::ACTUATOR_OUTPUT_STATUS => self.actuator_output_status(&scene),
            ids::ESC_STATUS if self.esc_telemetry => self.esc_status(&scene)?,
            ids::ESC_INFO if self.esc_telemetry => self.esc_info(&scene),
            ids::ESC_TELEMETRY_1_TO_4 => self.esc_telemetry(&scene),
            ids::GPS_RAW_INT => self.gps_raw_int(&scene),
            ids::LOCAL_POSITION_NED if has_origin => self.local_position_ned(&scene),
            ids::ODOMETRY if has_origin => self.odometry(&scene),
            ids::GLOBAL_POSITION_INT if has_origin => self.global_position_int(&scene),
            ids::GPS_GLOBAL_ORIGIN if has_origin => self.gps_global_origin(&scene),
            ids::HOME_POSITION => self.home_position(&scene)?,
            ids::ALTITUDE if has_origin => self.altitude(&scene),
            ids::VFR_HUD => self.vfr_hud(&scene),
            ids::POSITION_TARGET_LOCAL_NED if autopilot.is_armed() => self.position_target(&scene),
            _ => return None,
        })
    }
}

impl Scene<'_> {
    /// Milliseconds since boot of a sample that is stamped late by `skew_s` (s).
    fn ms(&self, skew_s: f64) -> u32 {
        u32::try_from(self.stamp(skew_s).as_millis()).unwrap_or(u32::MAX)
    }

    /// The same in microseconds.
    fn us(&self, skew_s: f64) -> u64 {
        u64::try_from(self.stamp(skew_s).as_micros()).unwrap_or(u64::MAX)
    }

    fn stamp(&self, skew_s: f64) -> Duration {
        self.at.now + Duration::try_from_secs_f64(skew_s).unwrap_or_default()
    }
}

/// TIMESYNC: `tc1` 0 asks, else it answers `ts1`; nanoseconds.
pub(super) fn timesync(tc1: i64, ts1: i64) -> Message {
    Message::new(ids::TIMESYNC).i64(tc1).i64(ts1)
}

/// Nanoseconds since boot.
pub(super) fn nanoseconds(now: Duration) -> i64 {
    i64::try_from(now.as_nanos()).unwrap_or(i64::MAX)
}

/// A value in a field of sixteen bits with sign; holds at its bounds.
fn short(value: f64) -> i16 {
    let whole = crate::units::whole(value).clamp(i16::MIN.into(), i16::MAX.into());
    i16::try_from(whole).unwrap_or_default()
}

/// The same without sign.
fn ushort(value: f64) -> u16 {
    u16::try_from(crate::units::whole(value).clamp(0, u16::MAX.into())).unwrap_or_default()
}
