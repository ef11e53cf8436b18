//! Health, mode, battery, clocks.

use super::super::Mode;
use super::super::battery::Charge;
use super::super::guidance::Task;
use super::super::message::Message;
use super::super::message_id as ids;
use super::field::{nanoseconds, ushort};
use super::scene::Scene;
use super::source::Telemetry;
use crate::autopilot::{Release, multirotor_type};
use crate::units::whole;

/// MAV_MODE_FLAG.
const CUSTOM_MODE: u8 = 1;
const AUTO: u8 = 4;
const GUIDED: u8 = 8;
const STABILIZE: u8 = 16;
const MANUAL_INPUT: u8 = 64;
const ARMED: u8 = 128;

/// MAV_STATE.
const STANDBY: u8 = 3;
const ACTIVE: u8 = 4;
const CRITICAL: u8 = 5;

/// MAV_SYS_STATUS_SENSOR.
const SENSORS: u32 = 0x1 | 0x2 | 0x4 | 0x8 | 0x20 | 0x400 | 0x1000 | 0x8000 | 0x20_0000;
const ALTITUDE_CONTROL: u32 = 0x2000;
const POSITION_CONTROL: u32 = 0x4000;
const RC_RECEIVER: u32 = 0x1_0000;
const BATTERY: u32 = 0x200_0000;
const PREARM_CHECK: u32 = 0x1000_0000;

/// ESTIMATOR_STATUS_FLAGS and EKF_STATUS_FLAGS: attitude, velocities, positions and their predictions.
const ESTIMATE_GOOD: u16 = 1 | 2 | 4 | 8 | 16 | 32 | 256 | 512;
const ESTIMATE_HEIGHT_ONLY: u16 = 1 | 4 | 32;
const CONSTANT_POSITION: u16 = 128;

/// MAV_PROTOCOL_CAPABILITY: missions and commands in integers, local setpoints, MAVLink 2, fence.
const CAPABILITIES: u64 = 4 | 8 | 128 | 8192 | 16_384;
/// Integer parameters as bytes, as values.
const BYTEWISE: u64 = 16;
const BY_VALUE: u64 = 131_072;

impl Telemetry {
    pub(super) fn heartbeat(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        let custom_mode = autopilot.mode.custom_mode(self.kind).unwrap_or(0);
        let own = match (self.kind.is_px4(), autopilot.mode) {
            (true, mode) if mode.is_manual() => MANUAL_INPUT | STABILIZE,
            (true, _) => AUTO | GUIDED | STABILIZE,
            (false, Mode::Guided | Mode::Return) => MANUAL_INPUT | STABILIZE | GUIDED,
            (false, _) => MANUAL_INPUT | STABILIZE,
        };
        let armed = if autopilot.is_armed() { ARMED } else { 0 };
        let flying = if self.kind.is_px4() { autopilot.is_armed() } else { !autopilot.is_landed() };
        let status = match (autopilot.safety.is_active(self.kind.is_px4()), flying) {
            (true, _) => CRITICAL,
            (false, true) => ACTIVE,
            (false, false) => STANDBY,
        };
        Message::new(ids::HEARTBEAT)
            .u32(custom_mode)
            .u8(multirotor_type(self.rotor_count))
            .u8(self.kind.stack().mav_autopilot)
            .u8(CUSTOM_MODE | own | armed)
            .u8(status)
            .u8(3)
    }

    pub(super) fn sys_status(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        let good = autopilot.estimator.is_good(scene.at.now);
        let mut present = SENSORS | ALTITUDE_CONTROL | POSITION_CONTROL | BATTERY;
        if autopilot.safety.has_transmitter() {
            present |= RC_RECEIVER;
        }
        let mut health = present;
        if !good {
            health &= !POSITION_CONTROL;
        }
        if autopilot.safety.charge() != Charge::Ok {
            health &= !BATTERY;
        }
        // PX4 shows its arming checks in the health alone
        if !self.kind.is_px4() {
            present |= PREARM_CHECK;
        }
        if autopilot.arming_refusals(scene.at.now).is_empty() {
            health |= PREARM_CHECK;
        }
        Message::new(ids::SYS_STATUS)
            .u32(present)
            .u32(present)
            .u32(health)
            .u16(150)
            .u16(ushort(autopilot.battery.volts() * 1e3))
            .i16(-1)
            .u16s(&[0; 6])
            .i8(percent(autopilot.battery.remaining()))
    }

    pub(super) fn battery_status(&self, scene: &Scene) -> Message {
        let battery = &scene.autopilot.battery;
        let mut voltages = [u16::MAX; 10];
        voltages[0] = ushort(battery.volts() * 1e3);
        Message::new(ids::BATTERY_STATUS)
            .i32(-1)
            .i32(-1)
            .i16(i16::MAX)
            .u16s(&voltages)
            .i16(-1)
            .u8(0)
            .u8(0)
            .u8(1)
            .i8(percent(battery.remaining()))
            .i32(0)
            .u8(scene.autopilot.safety.charge().mav())
    }

    pub(super) fn system_time(&self, scene: &Scene) -> Message {
        Message::new(ids::SYSTEM_TIME).u64(self.boot_unix_us + scene.us(0.0)).u32(scene.ms(0.0))
    }

    pub(super) fn ping(&mut self, scene: &Scene) -> Message {
        self.pings += 1;
        Message::new(ids::PING).u64(scene.us(0.0)).u32(self.pings).u8(0).u8(0)
    }

    /// A message that the dialect does not know.
    pub(super) fn link_node_status(&self, scene: &Scene) -> Message {
        let message = Message::foreign(ids::LINK_NODE_STATUS, 117).u64(scene.us(0.0));
        (0..5).fold(message, |message, _| message.u32(0)).u16s(&[0; 3]).u8(0).u8(0)
    }

    pub(super) fn autopilot_version(&self) -> Message {
        let parameters = if self.kind.is_px4() { BYTEWISE } else { BY_VALUE };
        let Release { major, minor } = self.kind.release();
        // FIRMWARE_VERSION_TYPE_OFFICIAL
        let version = [major, minor, 0, 255];
        Message::new(ids::AUTOPILOT_VERSION)
            .u64(CAPABILITIES | parameters)
            .u64(1)
            .u32(u32::from_be_bytes(version))
            .u32(0)
            .u32(0)
            .u32(0)
            .u16(0)
            .u16(0)
            .text(b"", 24)
            .text(&self.uid2, self.uid2.len())
    }

    pub(super) fn extended_sys_state(&self, scene: &Scene) -> Message {
        let autopilot = scene.autopilot;
        // MAV_LANDED_STATE
        let landed = match (autopilot.is_landed(), autopilot.guidance.task) {
            (true, _) => 1,
            (false, Task::Takeoff(_)) => 3,
            (false, Task::Land) => 4,
            (false, _) => 2,
        };
        Message::new(ids::EXTENDED_SYS_STATE).u8(0).u8(landed)
    }

    pub(super) fn current_mode(&self, scene: &Scene) -> Message {
        let number = |mode: Mode| mode.custom_mode(self.kind).unwrap_or(0);
        let autopilot = scene.autopilot;
        Message::new(ids::CURRENT_MODE).u32(number(autopilot.mode)).u32(number(autopilot.intended)).u8(0)
    }

    pub(super) fn estimator_status(&self, id: u32, scene: &Scene) -> Message {
        let estimator = &scene.autopilot.estimator;
        let ratio = estimator.test_ratio(scene.at.now);
        let good = estimator.is_good(scene.at.now);
        let flags = if good { ESTIMATE_GOOD } else { ESTIMATE_HEIGHT_ONLY };
        if id == ids::EKF_STATUS_REPORT {
            let flags = if good { flags } else { flags | CONSTANT_POSITION };
            return Message::new(id).f32s(&[ratio, ratio, 0.05, 0.05, 0.0]).u16(flags).f32(0.0);
        }
        // PX4 says so also of a vehicle that stands on the ground
        let flags = if scene.autopilot.is_landed() { flags | CONSTANT_POSITION } else { flags };
        let accuracy_m = if good { 0.3 } else { 50.0 };
        Message::new(id)
            .u64(scene.us(0.0))
            .f32s(&[ratio, ratio, 0.05, 0.05, f64::NAN, f64::NAN, accuracy_m, 0.4])
            .u16(flags)
    }

    /// Sticks centred, mode switch in the middle.
    pub(super) fn rc_channels(&self, scene: &Scene) -> Message {
        let mut channels = [u16::MAX; 18];
        channels[..8].fill(1500);
        Message::new(ids::RC_CHANNELS).u32(scene.ms(0.0)).u16s(&channels).u8(8).u8(254)
    }

    /// The answer to a TIMESYNC that asks.
    pub(in super::super) fn timesync_answer(now: std::time::Duration, asked: i64, to: (u8, u8)) -> Message {
        timesync(nanoseconds(now), asked).u8(to.0).u8(to.1)
    }
}

/// TIMESYNC: `tc1` 0 asks, else it answers `ts1`; nanoseconds.
pub(super) fn timesync(tc1: i64, ts1: i64) -> Message {
    Message::new(ids::TIMESYNC).i64(tc1).i64(ts1)
}

fn percent(share: f64) -> i8 {
    i8::try_from(whole(100.0 * share)).unwrap_or(-1)
}
