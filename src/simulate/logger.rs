//! Writes the log of a synthetic flight.

use crate::recording::landed::IN_AIR;
use std::collections::BTreeMap;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::SimulateError;
use super::controller::Setpoint;
use super::sensors::{NoiseLevels, TelemetrySettings};
use super::setting::{not_negative, positive, whole_steps};
use crate::physics::{MAX_ROTORS, State};
use crate::recording::{Quantity, Recording, Stream, StreamKey};

/// All that a log can take a sample of, at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// s
    pub(super) time_s: f64,
    /// as sensors without noise show it
    pub(super) state: State,
    /// what the controller last believed
    pub(super) estimate: State,
    /// the same of the accelerometer, m/s^2
    pub(super) specific_force_m_s2: Vector3<f64>,
    /// as the log holds them: u, or microseconds
    pub(super) actuators: [f64; MAX_ROTORS],
    /// rad/s, where known
    pub(super) rotor_speed_rad_s: Option<[f64; MAX_ROTORS]>,
    /// what is asked for
    pub(super) setpoint: Setpoint,
    /// V
    pub(super) battery_voltage_v: f64,
}

/// What the messages of one kind say, in the order of the schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Message {
    Attitude,
    Imu,
    Actuators,
    Position,
    RotorSpeed,
    Setpoint,
    Battery,
    Landed,
}

/// Resolution of a stamp.
const MILLISECOND_S: f64 = 1e-3;
const MICROSECOND_S: f64 = 1e-6;

/// One kind of message: when it is due and what it has written so far.
#[derive(Debug)]
struct Schedule {
    message: Message,
    source: &'static str,
    period_s: f64,
    sent: u32,
    skew_s: f64,
    stamp_resolution_s: f64,
    streams: Vec<(Quantity, Stream)>,
}

/// Writes the log of a flight.
#[derive(Debug)]
pub(super) struct Logger {
    settings: TelemetrySettings,
    noise: NoiseLevels,
    rotor_count: usize,
    schedules: Vec<Schedule>,
    rng: Pcg64Mcg,
}

impl Logger {
    /// A logger of a flight of `duration_s` (s) with `rotor_count` rotors.
    pub(super) fn new(
        settings: &TelemetrySettings,
        rotor_count: usize,
        duration_s: f64,
        seed: u64,
    ) -> Result<Self, SimulateError> {
        not_negative("noise_scale", settings.noise_scale)?;
        not_negative("clock_offset_s", settings.clock_offset_s)?;
        if !(0.0..1.0).contains(&settings.loss) {
            let value = settings.loss;
            return Err(SimulateError::Setting { name: "loss", expected: "in [0, 1)", value });
        }
        Ok(Self {
            settings: *settings,
            noise: settings.noise.scaled(settings.noise_scale),
            rotor_count,
            schedules: schedules(settings, rotor_count, duration_s)?,
            rng: Pcg64Mcg::seed_from_u64(seed),
        })
    }

    /// Logs whatever is due. Sample times are those at which this is called; a period that is no
    /// multiple of the calls' own gets samples at the first call after each due time, truly stamped.
    pub(super) fn log(&mut self, measured: &Measured) {
        let Self { settings, noise, rotor_count, schedules, rng } = self;
        for schedule in schedules {
            let due_s = f64::from(schedule.sent) * schedule.period_s;
            if measured.time_s < due_s - MICROSECOND_S {
                continue;
            }
            schedule.sent += 1;
            let seen = if settings.share_controller_noise {
                measured.estimate
            } else {
                noise.measure(rng, &measured.state)
            };
            let lost = rng.random::<f64>() < settings.loss;
            if lost {
                continue;
            }
            let stamp_s = settings.clock_offset_s + measured.time_s + schedule.skew_s;
            // a stamp that is a whole number of units already must not fall by rounding
            let units = (stamp_s / schedule.stamp_resolution_s + 1e-6).floor();
            for (_, stream) in &mut schedule.streams {
                stream.time_s.push(units * schedule.stamp_resolution_s);
            }
            let rotors = *rotor_count;
            write(schedule, measured, &seen, &mut Instruments { noise, rng, rotors });
        }
    }

    /// The recording, stamped from its own first sample.
    pub(super) fn finish(self) -> Recording {
        let mut streams = BTreeMap::new();
        for schedule in self.schedules {
            // body rates of ATTITUDE_QUATERNION and HIGHRES_IMU differ in source, not in instance
            for (quantity, stream) in schedule.streams {
                streams.insert(StreamKey { quantity, source: schedule.source, instance: 0 }, stream);
            }
        }
        let start_s = streams
            .values()
            .filter_map(|stream: &Stream| stream.time_s.first().copied())
            .fold(f64::INFINITY, f64::min);
        for stream in streams.values_mut() {
            for time_s in &mut stream.time_s {
                *time_s -= start_s;
            }
        }
        Recording { streams, ..Recording::default() }
    }
}

/// What adds noise while a message is written.
struct Instruments<'a> {
    noise: &'a NoiseLevels,
    rng: &'a mut Pcg64Mcg,
    rotors: usize,
}

/// Appends one sample to each stream of a message.
fn write(schedule: &mut Schedule, measured: &Measured, seen: &State, with: &mut Instruments) {
    let mut put = |slot: usize, values: &[f64]| schedule.streams[slot].1.values.extend_from_slice(values);
    match schedule.message {
        Message::Attitude => {
            let q = seen.attitude.quaternion();
            put(0, &[q.w, q.i, q.j, q.k]);
            put(1, seen.rates_rad_s.as_slice());
        }
        Message::Imu => {
            let force = with.noise.measure_force(with.rng, &measured.specific_force_m_s2);
            put(0, force.as_slice());
            put(1, seen.rates_rad_s.as_slice());
        }
        Message::Actuators => put(0, &measured.actuators[..with.rotors]),
        Message::Position => {
            put(0, seen.position_m.as_slice());
            put(1, seen.velocity_m_s.as_slice());
        }
        Message::RotorSpeed => {
            let mut speeds = measured.rotor_speed_rad_s.unwrap_or([f64::NAN; MAX_ROTORS]);
            for speed in &mut speeds {
                // ESC_STATUS counts whole revolutions per minute
                let one_rpm = crate::units::rad_s_from_rpm(1.0);
                *speed = (*speed / one_rpm).round() * one_rpm;
            }
            put(0, &speeds[..with.rotors]);
        }
        Message::Setpoint => {
            put(0, measured.setpoint.position_m.as_slice());
            put(1, measured.setpoint.velocity_m_s.as_slice());
            put(2, measured.setpoint.acceleration_m_s2.as_slice());
            put(3, &[measured.setpoint.yaw_rad]);
        }
        Message::Battery => put(0, &[measured.battery_voltage_v]),
        Message::Landed => put(0, &[IN_AIR]),
    }
}

/// A message before it is scheduled.
struct Plan {
    message: Message,
    source: &'static str,
    /// key of the settings and its value, Hz
    rate: (&'static str, f64),
    skew_s: f64,
    resolution_s: f64,
    /// quantities and their widths
    streams: Vec<(Quantity, usize)>,
}

impl Plan {
    fn schedule(self, duration_s: f64) -> Result<Schedule, SimulateError> {
        let (name, rate_hz) = self.rate;
        let period_s = 1.0 / positive(name, rate_hz)?;
        not_negative("skew", self.skew_s)?;
        // a hint, so it is bounded
        let samples = whole_steps(name, duration_s, period_s)?.min(1 << 20) + 1;
        let empty = |(quantity, width): (Quantity, usize)| {
            let time_s = Vec::with_capacity(samples);
            (quantity, Stream { time_s, width, values: Vec::with_capacity(samples * width) })
        };
        Ok(Schedule {
            message: self.message,
            source: self.source,
            period_s,
            sent: 0,
            skew_s: self.skew_s,
            stamp_resolution_s: self.resolution_s,
            streams: self.streams.into_iter().map(empty).collect(),
        })
    }
}

fn schedules(
    settings: &TelemetrySettings,
    rotors: usize,
    duration_s: f64,
) -> Result<Vec<Schedule>, SimulateError> {
    plans(settings, rotors).into_iter().map(|plan| plan.schedule(duration_s)).collect()
}

/// What is sent, message by message.
fn plans(settings: &TelemetrySettings, rotors: usize) -> Vec<Plan> {
    use Quantity as Q;
    let (rates, skew) = (&settings.rates, &settings.skew);
    let (ms, us) = (MILLISECOND_S, MICROSECOND_S);
    let plan = |message, source, rate, (skew_s, resolution_s), streams: &[(Q, usize)]| Plan {
        message,
        source,
        rate,
        skew_s,
        resolution_s,
        streams: streams.to_vec(),
    };
    let rate = ("attitude_hz", rates.attitude_hz);
    let attitude = [(Q::Attitude, 4), (Q::AngularRate, 3)];
    let attitude = plan(Message::Attitude, "ATTITUDE_QUATERNION", rate, (skew.attitude_s, ms), &attitude);
    let rate = ("imu_hz", rates.imu_hz);
    let imu = [(Q::SpecificForce, 3), (Q::AngularRate, 3)];
    let imu = plan(Message::Imu, "HIGHRES_IMU", rate, (skew.imu_s, us), &imu);
    let rate = ("actuator_hz", rates.actuator_hz);
    let actuators = [(Q::ActuatorCommand, rotors)];
    let actuators =
        plan(Message::Actuators, "ACTUATOR_OUTPUT_STATUS", rate, (skew.actuator_s, us), &actuators);
    let rate = ("position_hz", rates.position_hz);
    let position = [(Q::Position, 3), (Q::Velocity, 3)];
    let position = plan(Message::Position, "LOCAL_POSITION_NED", rate, (skew.position_s, ms), &position);
    let speeds = rates.rotor_speed_hz.map(|rate_hz| {
        let (rate, streams) = (("rotor_speed_hz", rate_hz), [(Q::RotorSpeed, rotors)]);
        plan(Message::RotorSpeed, "ESC_STATUS", rate, (skew.rotor_speed_s, us), &streams)
    });
    let rate = ("setpoint_hz", rates.setpoint_hz);
    let setpoint = [
        (Q::PositionSetpoint, 3),
        (Q::VelocitySetpoint, 3),
        (Q::AccelerationSetpoint, 3),
        (Q::YawSetpoint, 1),
    ];
    let setpoint = plan(Message::Setpoint, "POSITION_TARGET_LOCAL_NED", rate, (0.0, ms), &setpoint);
    let rate = ("battery_hz", rates.battery_hz);
    let battery = plan(Message::Battery, "BATTERY_STATUS", rate, (0.0, ms), &[(Q::BatteryVoltage, 1)]);
    let rate = ("landed_hz", rates.landed_hz);
    let landed = plan(Message::Landed, "EXTENDED_SYS_STATE", rate, (0.0, ms), &[(Q::LandedState, 1)]);
    let before = [attitude, imu, actuators, position].into_iter();
    before.chain(speeds).chain([setpoint, battery, landed]).collect()
}
