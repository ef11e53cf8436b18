//! A flight as a telemetry log. What is measured and how it is turned to the messages' axes is this maker's own; only
//! the frames and stamps are the library's.

use mavid::units::{narrow, whole};
use mavid::wire::MessageWriter;
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

use super::dice;
use super::flight::{Instant, TICK};
use super::hidden::Hidden;

/// How a flight was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// ticks between two messages of the fast streams
    pub every: usize,
    /// of 1.7 mrad, 7 mrad/s, 0.1 m/s^2, 4 mm, 15 mm/s
    pub noise: f64,
    /// s by which attitudes are stamped late
    pub attitude_late: f64,
    /// s by which positions are
    pub position_late: f64,
    /// whether rotor speeds are told
    pub speeds: bool,
}

impl Conditions {
    /// Those of a seed: every third as the practice cases are.
    pub fn random(seed: u64) -> Self {
        let mut dice = dice(seed, 5);
        let speeds = dice.random_bool(0.5);
        let plain = Self { every: 2, noise: 1.0, attitude_late: 0.0, position_late: 0.0, speeds };
        if seed.is_multiple_of(3) {
            return plain;
        }
        Self {
            every: dice.random_range(1..=5),
            noise: 0.5 * 6_f64.powf(dice.random_range(0.0..1.0)),
            attitude_late: 0.01 * dice.random_range(-1.0..1.0),
            position_late: 0.01 * dice.random_range(-1.0..1.0),
            speeds,
        }
    }
}

/// Host's clock when the recording begins, microseconds since 1970.
pub const HOST_US: f64 = 1.79e15;

/// Share of the frames that never arrive.
const LOST: f64 = 0.004;

/// The log's bytes.
pub fn log(flown: &[Instant], hidden: &Hidden, (seed, with): (u64, Conditions)) -> Vec<u8> {
    let mut dice = dice(seed, 6);
    let boot = 41.0 + 0.001 * f64::from(dice.random_range(0..9000_u32));
    let mut frames: Vec<(f64, MavMessage)> = Vec::new();
    for (tick, now) in flown.iter().enumerate() {
        let time = boot + tick as f64 * TICK;
        for message in messages(tick, time, now, (hidden, with), &mut dice) {
            let jitter: f64 = StandardNormal.sample(&mut dice);
            frames.push((time + 0.0001 + 0.0015 * jitter.abs(), message));
        }
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

/// What is sent at a tick.
fn messages(
    tick: usize,
    time: f64,
    now: &Instant,
    (hidden, with): (&Hidden, Conditions),
    dice: &mut impl Rng,
) -> Vec<MavMessage> {
    let mut out = Vec::new();
    let due = |every: usize| tick.is_multiple_of(every);
    if due(250) {
        out.push(heartbeat());
        out.push(in_air());
    }
    if due(with.every) {
        out.push(attitude(time + with.attitude_late, now, (hidden, with), dice));
        out.push(inertial(time, now, (hidden, with), dice));
        let mut message =
            dialect::ACTUATOR_OUTPUT_STATUS_DATA { time_usec: micros(time), active: 4, ..Default::default() };
        message.actuator.iter_mut().zip(now.command).for_each(|(slot, value)| *slot = narrow(value));
        out.push(MavMessage::ACTUATOR_OUTPUT_STATUS(message));
    }
    if with.speeds && due(2 * with.every) {
        let mut message = dialect::ESC_STATUS_DATA { time_usec: micros(time), ..Default::default() };
        let rpm = |speed: f64| whole(speed * 30.0 / std::f64::consts::PI);
        message.rpm.iter_mut().zip(now.speeds).for_each(|(slot, speed)| *slot = rpm(speed));
        out.push(MavMessage::ESC_STATUS(message));
    }
    if due(5) {
        out.push(position(time + with.position_late, now, (hidden, with), dice));
    }
    if due(10) {
        out.push(setpoint(time, now));
    }
    if due(125) {
        out.push(battery(now, dice));
    }
    out
}

/// The pack's voltage and current.
pub fn battery(now: &Instant, dice: &mut impl Rng) -> MavMessage {
    let mut message = dialect::BATTERY_STATUS_DATA { voltages: [u16::MAX; 10], ..Default::default() };
    let cell = now.volts / 4.0 + 0.001 * drawn(dice);
    message.voltages[..4].fill(u16::try_from(whole(1000.0 * cell)).unwrap_or(u16::MAX));
    message.current_battery = i16::try_from(whole(100.0 * now.amperes)).unwrap_or(i16::MAX);
    message.battery_remaining = 70;
    MavMessage::BATTERY_STATUS(message)
}

/// That the vehicle flies.
pub fn in_air() -> MavMessage {
    MavMessage::EXTENDED_SYS_STATE(dialect::EXTENDED_SYS_STATE_DATA {
        landed_state: dialect::MavLandedState::MAV_LANDED_STATE_IN_AIR,
        ..Default::default()
    })
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        // OFFBOARD
        custom_mode: 6 << 16,
        mavtype: dialect::MavType::MAV_TYPE_QUADROTOR,
        autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_PX4,
        base_mode: dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED
            | dialect::MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
        system_status: dialect::MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}

type SensorConditions<'a> = (&'a Hidden, Conditions);

fn attitude(time: f64, now: &Instant, (hidden, with): SensorConditions, dice: &mut impl Rng) -> MavMessage {
    let seen = if hidden.attitude_in_frame {
        hidden.frame_turned.inverse().matrix() * now.rotation
    } else {
        now.rotation
    };
    let shaken = seen * Rotation3::new(noise(0.0017 * with.noise, dice)).matrix();
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(shaken));
    let mut rates = now.rates + noise(0.007 * with.noise, dice);
    if hidden.rates_turned {
        rates = hidden.imu_turned * rates;
    }
    // to down and right
    let [q1, q2, q3, q4] = [q.w, q.i, -q.j, -q.k].map(narrow);
    let [rollspeed, pitchspeed, yawspeed] = mirrored(&rates);
    MavMessage::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
        time_boot_ms: millis(time),
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

fn inertial(time: f64, now: &Instant, (hidden, with): SensorConditions, dice: &mut impl Rng) -> MavMessage {
    let from = hidden.imu_at;
    let carried = now.angular.cross(&from) + now.rates.cross(&now.rates.cross(&from));
    let felt = hidden.imu_turned * (now.specific_force + carried) + noise(0.1 * with.noise, dice);
    let rates = hidden.imu_turned * now.rates + noise(0.007 * with.noise, dice);
    let [xacc, yacc, zacc] = mirrored(&felt);
    let [xgyro, ygyro, zgyro] = mirrored(&rates);
    MavMessage::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
        time_usec: micros(time),
        xacc,
        yacc,
        zacc,
        xgyro,
        ygyro,
        zgyro,
        xmag: 0.21,
        zmag: 0.42,
        abs_pressure: 1013.2,
        pressure_alt: 100.0,
        temperature: 31.0,
        fields_updated: dialect::HighresImuUpdatedFlags::from_bits_truncate(0b11_1111),
        ..Default::default()
    })
}

fn position(time: f64, now: &Instant, (hidden, with): SensorConditions, dice: &mut impl Rng) -> MavMessage {
    let into = hidden.frame_turned.inverse();
    let [x, y, z] = mirrored(&(into * now.position + noise(0.004 * with.noise, dice)));
    let [vx, vy, vz] = mirrored(&(into * now.velocity + noise(0.015 * with.noise, dice)));
    let time_boot_ms = millis(time);
    MavMessage::LOCAL_POSITION_NED(dialect::LOCAL_POSITION_NED_DATA { time_boot_ms, x, y, z, vx, vy, vz })
}

/// What was asked for.
pub fn setpoint(time: f64, now: &Instant) -> MavMessage {
    let [x, y, z] = mirrored(&now.wanted.position);
    let [vx, vy, vz] = mirrored(&now.wanted.velocity);
    let [afx, afy, afz] = mirrored(&now.wanted.acceleration);
    MavMessage::POSITION_TARGET_LOCAL_NED(dialect::POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: millis(time),
        x,
        y,
        z,
        vx,
        vy,
        vz,
        afx,
        afy,
        afz,
        yaw: narrow(-now.wanted.yaw),
        yaw_rate: narrow(-now.wanted.yaw_rate),
        coordinate_frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
        ..Default::default()
    })
}

/// From left and up to right and down, or north, west, up to north, east, down.
pub fn mirrored(value: &Vector3<f64>) -> [f32; 3] {
    [narrow(value.x), narrow(-value.y), narrow(-value.z)]
}

fn noise(sigma: f64, dice: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| sigma * drawn(dice))
}

fn drawn(dice: &mut impl Rng) -> f64 {
    StandardNormal.sample(dice)
}

/// Microseconds of a time in s.
pub fn micros(time: f64) -> u64 {
    let time = std::time::Duration::try_from_secs_f64(time + 1e-7).unwrap_or_default();
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

/// Milliseconds of a time in s.
pub fn millis(time: f64) -> u32 {
    u32::try_from(micros(time + 0.0005) / 1000).unwrap_or(u32::MAX)
}
