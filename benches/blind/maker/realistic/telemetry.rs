//! Beliefs and readings as a telemetry log.

use mavid::units::{narrow, whole};
use mavid::wire::MessageWriter;
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt};

use super::super::flight::TICK;
use super::super::telemetry::{HOST_US, battery, in_air, micros, millis, mirrored, setpoint};
use super::super::{GRAVITY, dice};
use super::flight::{Flown, Tick};
use super::position::Fix;
use super::streams::{Due, Streams};
use super::{drawn, drawn_three};

/// Share of the frames that never arrive.
const LOST: f64 = 0.005;

/// The log's bytes.
pub fn log(flown: &Flown, streams: &Streams, seed: u64) -> Vec<u8> {
    let mut dice = dice(seed, 10);
    let boot = 41.0 + 0.001 * f64::from(dice.random_range(0..9000_u32));
    let mut frames: Vec<(f64, MavMessage)> = Vec::new();
    let mut schedule = Schedule::new(streams, &mut dice);
    for (count, tick) in flown.ticks.iter().enumerate() {
        let since = count as f64 * TICK;
        for message in schedule.messages((since, boot), tick, &mut dice) {
            // now and then the link is busy
            let busy = if dice.random_bool(0.001) { dice.random_range(0.02..0.1) } else { 0.0 };
            frames.push((boot + since + 0.0001 + busy + drawn(streams.jitter, &mut dice).abs(), message));
        }
    }
    for fix in flown.fixes.iter().filter(|fix| fix.velocity.is_some()) {
        let late = drawn(streams.jitter, &mut dice).abs();
        frames.push((boot + fix.arrives + late, receiver(boot + fix.arrives, fix, &mut dice)));
    }
    frames.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut log = MessageWriter::new(Vec::with_capacity(frames.len() * 70));
    for (time, message) in frames {
        if dice.random_bool(LOST) {
            log.lose();
        } else {
            log.write(micros(HOST_US * 1e-6 + time - boot), &message).expect("memory takes all");
        }
    }
    log.finish().expect("memory takes all")
}

/// What is due when.
struct Schedule<'a> {
    streams: &'a Streams,
    /// attitude, position, inertial unit, commands, rotor speeds, setpoints, battery, heartbeats
    due: [Due; 8],
}

impl<'a> Schedule<'a> {
    fn new(streams: &'a Streams, dice: &mut impl Rng) -> Self {
        let rates = [
            streams.attitude,
            streams.position,
            streams.inertial,
            streams.commands,
            streams.speeds,
            5.0,
            2.0,
            1.0,
        ];
        Self { streams, due: rates.map(|rate| Due::new(rate, dice)) }
    }

    /// What is sent at a tick.
    fn messages(&mut self, (since, boot): (f64, f64), tick: &Tick, dice: &mut impl Rng) -> Vec<MavMessage> {
        let streams = self.streams;
        let due: [bool; 8] = std::array::from_fn(|stream| self.due[stream].is_due(since, dice));
        let time = boot + since;
        let mut out = Vec::new();
        if due[0] {
            out.push(attitude(time + streams.skew_attitude, tick, streams.ardupilot));
        }
        if due[1] {
            out.push(position(time + streams.skew_position, tick));
        }
        if due[2] {
            out.push(inertial(time + streams.skew_inertial, tick, streams.ardupilot));
        }
        if due[3] {
            out.push(commands(time + streams.skew_commands, tick, streams.ardupilot));
        }
        if due[4] {
            let time_usec = micros(time + streams.skew_commands);
            let mut message = dialect::ESC_STATUS_DATA { time_usec, ..Default::default() };
            let rpm = |speed: f64| whole(speed * 30.0 / std::f64::consts::PI);
            message.rpm.iter_mut().zip(tick.truth.speeds).for_each(|(slot, speed)| *slot = rpm(speed));
            out.push(MavMessage::ESC_STATUS(message));
        }
        if due[5] {
            out.push(setpoint(time, &tick.truth));
        }
        if due[6] {
            out.push(battery(&tick.truth, dice));
        }
        if due[7] {
            out.push(heartbeat(streams.ardupilot));
            out.push(in_air());
        }
        out
    }
}

fn heartbeat(ardupilot: bool) -> MavMessage {
    // GUIDED or OFFBOARD
    let (autopilot, custom_mode) = if ardupilot {
        (dialect::MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA, 4)
    } else {
        (dialect::MavAutopilot::MAV_AUTOPILOT_PX4, 6 << 16)
    };
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        custom_mode,
        mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
        autopilot,
        base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED
            | dialect::MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
        system_status: dialect::MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

fn attitude(time: f64, tick: &Tick, ardupilot: bool) -> MavMessage {
    let turn = Rotation3::from_matrix_unchecked(tick.belief.rotation);
    let [rollspeed, pitchspeed, yawspeed] = mirrored(&tick.belief.rates);
    let time_boot_ms = millis(time);
    if ardupilot {
        let (roll, pitch, yaw) = turn.euler_angles();
        let [roll, pitch, yaw] = [roll, -pitch, -yaw].map(narrow);
        let message =
            dialect::ATTITUDE_DATA { time_boot_ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed };
        return MavMessage::ATTITUDE(message);
    }
    let q = UnitQuaternion::from_rotation_matrix(&turn);
    let [q1, q2, q3, q4] = [q.w, q.i, -q.j, -q.k].map(narrow);
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

fn position(time: f64, tick: &Tick) -> MavMessage {
    let [x, y, z] = mirrored(&tick.belief.position);
    let [vx, vy, vz] = mirrored(&tick.belief.velocity);
    let time_boot_ms = millis(time);
    MavMessage::LOCAL_POSITION_NED(dialect::LOCAL_POSITION_NED_DATA { time_boot_ms, x, y, z, vx, vy, vz })
}

fn inertial(time: f64, tick: &Tick, ardupilot: bool) -> MavMessage {
    let time_usec = micros(time);
    if ardupilot {
        let short = |value: f32| i16::try_from(whole(f64::from(value))).unwrap_or(i16::MAX);
        // milli g and mrad/s
        let [xacc, yacc, zacc] = mirrored(&(tick.sample.slow_force * 1000.0 / GRAVITY)).map(short);
        let [xgyro, ygyro, zgyro] = mirrored(&(tick.sample.slow_rates * 1000.0)).map(short);
        return MavMessage::RAW_IMU(dialect::RAW_IMU_DATA {
            time_usec,
            xacc,
            yacc,
            zacc,
            xgyro,
            ygyro,
            zgyro,
            xmag: 210,
            zmag: 420,
            ..Default::default()
        });
    }
    let [xacc, yacc, zacc] = mirrored(&tick.sample.force);
    let [xgyro, ygyro, zgyro] = mirrored(&tick.sample.rates);
    MavMessage::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
        time_usec,
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag: 0.21,
        zmag: 0.42,
        abs_pressure: narrow(1013.2 - 0.12 * tick.belief.position.z),
        pressure_alt: narrow(FIELD.2 + tick.belief.position.z),
        temperature: 31.0,
        fields_updated: dialect::HighresImuUpdatedFlags::from_bits_truncate(0b11_1111),
        ..Default::default()
    })
}

fn commands(time: f64, tick: &Tick, ardupilot: bool) -> MavMessage {
    if ardupilot {
        let pulses =
            tick.truth.command.map(|value| u16::try_from(whole(1000.0 + 1000.0 * value)).unwrap_or(0));
        let [servo1_raw, servo2_raw, servo3_raw, servo4_raw] = pulses;
        return MavMessage::SERVO_OUTPUT_RAW(dialect::SERVO_OUTPUT_RAW_DATA {
            time_usec: u32::try_from(micros(time)).unwrap_or(u32::MAX),
            servo1_raw,
            servo2_raw,
            servo3_raw,
            servo4_raw,
            ..Default::default()
        });
    }
    let mut message =
        dialect::ACTUATOR_OUTPUT_STATUS_DATA { time_usec: micros(time), active: 4, ..Default::default() };
    message.actuator.iter_mut().zip(tick.truth.command).for_each(|(slot, value)| *slot = narrow(value));
    MavMessage::ACTUATOR_OUTPUT_STATUS(message)
}

/// Latitude and longitude of the field, degrees, and its height, m.
const FIELD: (f64, f64, f64) = (47.397_744, 8.545_594, 487.7);

/// m in a degree of latitude
const DEGREE: f64 = 111_194.93;

fn receiver(time: f64, fix: &Fix, dice: &mut impl Rng) -> MavMessage {
    let Fix { position, .. } = fix;
    let velocity: Vector3<f64> = fix.velocity.unwrap_or_else(|| drawn_three(0.0, dice));
    let (north, east) = (velocity.x, -velocity.y);
    let narrowing = FIELD.0.to_radians().cos();
    let small = |value: f64| u16::try_from(whole(value)).unwrap_or(u16::MAX);
    MavMessage::GPS_RAW_INT(dialect::GPS_RAW_INT_DATA {
        time_usec: micros(time),
        fix_type: dialect::GpsFixType::GPS_FIX_TYPE_3D_FIX,
        lat: whole(1e7 * (FIELD.0 + position.x / DEGREE)),
        lon: whole(1e7 * (FIELD.1 - position.y / (DEGREE * narrowing))),
        alt: whole(1000.0 * (FIELD.2 + position.z)),
        eph: 90,
        epv: 140,
        vel: small(100.0 * north.hypot(east)),
        cog: small(100.0 * east.atan2(north).to_degrees().rem_euclid(360.0)) % 36000,
        satellites_visible: 14,
        ..Default::default()
    })
}
