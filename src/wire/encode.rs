//! A recording as a telemetry log: what a simulated flight would have sent.

use std::io::{self, Write};
use std::time::Duration;

use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::stamped::MessageWriter;
use crate::frames::{
    Attitude, Body, World, frd_from_body, frd_ned_from_attitude, ned_from_world, yaw_from_ned,
};
use crate::recording::{Quantity, Recording, Stream};
use crate::units::{narrow, rad_s_from_rpm, whole};

/// Time between heartbeats, s.
const HEARTBEAT_S: f64 = 1.0;

/// The bits of HIGHRES_IMU's accelerations and rates.
const INERTIAL_FIELDS: u16 = 0b11_1111;

/// Writes the streams that a simulated flight holds (`ATTITUDE_QUATERNION`, `HIGHRES_IMU`,
/// `ACTUATOR_OUTPUT_STATUS`, `LOCAL_POSITION_NED`, `ESC_STATUS`, `POSITION_TARGET_LOCAL_NED`,
/// `BATTERY_STATUS`, `EXTENDED_SYS_STATE`) with heartbeats, in the order of their times; `start_us` is the
/// host's time (microseconds since 1970 UTC) at the recording's start. Returns the number of frames.
///
/// # Errors
/// What the writer beneath reports, and streams of other messages ([`io::ErrorKind::Unsupported`]).
pub fn write_recording(recording: &Recording, to: impl Write, start_us: u64) -> io::Result<u64> {
    let mut messages = Vec::new();
    let mut end_s = 0.0_f64;
    for (key, stream) in &recording.streams {
        end_s = end_s.max(stream.time_s.last().copied().unwrap_or(0.0));
        // the quantity that a message is known by; the others of the same source ride along
        let Some(lead) = lead(key.source) else {
            let what = format!("cannot write {} as a message", key.source);
            return Err(io::Error::new(io::ErrorKind::Unsupported, what));
        };
        if lead != key.quantity {
            continue;
        }
        for index in 0..stream.len() {
            let sample = Sample { recording, source: key.source, index };
            messages.push((stream.time_s[index], sample.message(stream.time_s[index], stream)));
        }
    }
    let mut beat_s = 0.0;
    while beat_s <= end_s {
        messages.push((beat_s, heartbeat()));
        beat_s += HEARTBEAT_S;
    }
    messages.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut log = MessageWriter::new(to);
    for (time_s, message) in &messages {
        log.write(start_us + micros(*time_s), message)?;
    }
    log.finish()?;
    Ok(messages.len() as u64)
}

fn lead(source: &str) -> Option<Quantity> {
    Some(match source {
        "ATTITUDE_QUATERNION" => Quantity::Attitude,
        "HIGHRES_IMU" => Quantity::SpecificForce,
        "ACTUATOR_OUTPUT_STATUS" => Quantity::ActuatorCommand,
        "LOCAL_POSITION_NED" => Quantity::Position,
        "ESC_STATUS" => Quantity::RotorSpeed,
        "POSITION_TARGET_LOCAL_NED" => Quantity::PositionSetpoint,
        "BATTERY_STATUS" => Quantity::BatteryVoltage,
        "EXTENDED_SYS_STATE" => Quantity::LandedState,
        _ => return None,
    })
}

/// One sample of all streams of a source.
struct Sample<'a> {
    recording: &'a Recording,
    source: &'static str,
    index: usize,
}

impl Sample<'_> {
    /// NaN where the source has no such stream.
    fn vector(&self, quantity: Quantity) -> Vector3<f64> {
        let find = |(key, _): &(&crate::recording::StreamKey, &Stream)| {
            key.quantity == quantity && key.source == self.source
        };
        let stream = self.recording.streams.iter().find(find).map(|(_, stream)| stream);
        match stream.filter(|stream| self.index < stream.len() && stream.width == 3) {
            Some(stream) => Vector3::from_column_slice(stream.sample(self.index)),
            None => Vector3::repeat(f64::NAN),
        }
    }

    fn ned(&self, quantity: Quantity) -> [f32; 3] {
        ned_from_world(World(self.vector(quantity))).map(narrow)
    }

    fn frd(&self, quantity: Quantity) -> [f32; 3] {
        frd_from_body(Body(self.vector(quantity))).map(narrow)
    }

    fn message(&self, time_s: f64, stream: &Stream) -> MavMessage {
        let values = stream.sample(self.index);
        let (time_usec, time_boot_ms) = (micros(time_s), millis(time_s));
        match stream_kind(self.source) {
            Kind::Attitude => self.attitude(time_boot_ms, values),
            Kind::Inertial => self.inertial(time_usec),
            Kind::Actuators => {
                let mut message = dialect::ACTUATOR_OUTPUT_STATUS_DATA { time_usec, ..Default::default() };
                for (slot, value) in message.actuator.iter_mut().zip(values) {
                    *slot = narrow(*value);
                    message.active += 1;
                }
                MavMessage::ACTUATOR_OUTPUT_STATUS(message)
            }
            Kind::Position => {
                let ([x, y, z], [vx, vy, vz]) = (self.ned(Quantity::Position), self.ned(Quantity::Velocity));
                let place = dialect::LOCAL_POSITION_NED_DATA { time_boot_ms, x, y, z, vx, vy, vz };
                MavMessage::LOCAL_POSITION_NED(place)
            }
            Kind::RotorSpeed => {
                let mut message = dialect::ESC_STATUS_DATA { time_usec, ..Default::default() };
                for (slot, speed) in message.rpm.iter_mut().zip(values) {
                    *slot = whole(speed / rad_s_from_rpm(1.0));
                }
                MavMessage::ESC_STATUS(message)
            }
            Kind::Setpoint => self.setpoint(time_boot_ms),
            Kind::Battery => {
                let mut message =
                    dialect::BATTERY_STATUS_DATA { voltages: [u16::MAX; 10], ..Default::default() };
                message.voltages[0] = u16::try_from(whole(values[0] * 1e3)).unwrap_or(u16::MAX);
                MavMessage::BATTERY_STATUS(message)
            }
            Kind::Landed => MavMessage::EXTENDED_SYS_STATE(dialect::EXTENDED_SYS_STATE_DATA {
                landed_state: dialect::MavLandedState::MAV_LANDED_STATE_IN_AIR,
                ..Default::default()
            }),
        }
    }

    /// `values`: quaternion w x y z, body to world.
    fn attitude(&self, time_boot_ms: u32, values: &[f64]) -> MavMessage {
        let q = Quaternion::new(values[0], values[1], values[2], values[3]);
        let attitude = Attitude(UnitQuaternion::from_quaternion(q));
        let [q1, q2, q3, q4] = frd_ned_from_attitude(attitude).map(narrow);
        let [rollspeed, pitchspeed, yawspeed] = self.frd(Quantity::AngularRate);
        MavMessage::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
            time_boot_ms,
            q1,
            q2,
            q3,
            q4,
            rollspeed,
            pitchspeed,
            yawspeed,
            ..Default::default()
        })
    }

    fn inertial(&self, time_usec: u64) -> MavMessage {
        let [xacc, yacc, zacc] = self.frd(Quantity::SpecificForce);
        let [xgyro, ygyro, zgyro] = self.frd(Quantity::AngularRate);
        MavMessage::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
            time_usec,
            xacc,
            yacc,
            zacc,
            xgyro,
            ygyro,
            zgyro,
            fields_updated: dialect::HighresImuUpdatedFlags::from_bits_truncate(INERTIAL_FIELDS),
            ..Default::default()
        })
    }

    fn setpoint(&self, time_boot_ms: u32) -> MavMessage {
        let [x, y, z] = self.ned(Quantity::PositionSetpoint);
        let [vx, vy, vz] = self.ned(Quantity::VelocitySetpoint);
        let [afx, afy, afz] = self.ned(Quantity::AccelerationSetpoint);
        MavMessage::POSITION_TARGET_LOCAL_NED(dialect::POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms,
            x,
            y,
            z,
            vx,
            vy,
            vz,
            afx,
            afy,
            afz,
            yaw: self.yaw_setpoint(),
            coordinate_frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
            type_mask: dialect::PositionTargetTypemask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE,
            ..Default::default()
        })
    }

    fn yaw_setpoint(&self) -> f32 {
        let find = |(key, _): &(&crate::recording::StreamKey, &Stream)| {
            key.quantity == Quantity::YawSetpoint && key.source == self.source
        };
        let stream = self.recording.streams.iter().find(find).map(|(_, stream)| stream);
        let yaw = stream.and_then(|stream| stream.values.get(self.index)).copied().unwrap_or(f64::NAN);
        // the same mirror both ways
        narrow(yaw_from_ned(yaw))
    }
}

/// What a message is about.
enum Kind {
    Attitude,
    Inertial,
    Actuators,
    Position,
    RotorSpeed,
    Setpoint,
    Battery,
    Landed,
}

fn stream_kind(source: &str) -> Kind {
    match source {
        "ATTITUDE_QUATERNION" => Kind::Attitude,
        "HIGHRES_IMU" => Kind::Inertial,
        "ACTUATOR_OUTPUT_STATUS" => Kind::Actuators,
        "LOCAL_POSITION_NED" => Kind::Position,
        "ESC_STATUS" => Kind::RotorSpeed,
        "POSITION_TARGET_LOCAL_NED" => Kind::Setpoint,
        "BATTERY_STATUS" => Kind::Battery,
        _ => Kind::Landed,
    }
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
        autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_GENERIC,
        base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED,
        system_status: dialect::MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
        ..Default::default()
    })
}

fn micros(time_s: f64) -> u64 {
    // a time that is a whole number of microseconds already must not fall by rounding
    let time = Duration::try_from_secs_f64(time_s + 1e-9).unwrap_or_default();
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

fn millis(time_s: f64) -> u32 {
    u32::try_from(micros(time_s) / 1000).unwrap_or(u32::MAX)
}
