//! Keeps the vehicle's log: decides when one is written, and gives each instant to the writer.

use std::time::Duration;

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::dataflash::DataflashWriter;
use super::date::gps_time;
use super::moment::{Moment, SensorReading};
use super::schedule::{Schedule, When};
use super::store::LogStore;
use super::ulog::{Software, UlogWriter};
use crate::autopilot::ParameterType;
use crate::frames::{Body, frd_from_body};
use crate::physics::MAX_ROTORS;
use crate::simulate::NoiseLevels;
use crate::sitl::autopilot::{Autopilot, Text};
use crate::sitl::parameters::{Parameters, Pulses};
use crate::sitl::telemetry::Snapshot;
use crate::sitl::{Firmware, Origin, Settings};
use crate::vehicle::Spin;

/// Keeps the log's noise apart from that of the telemetry and of the autopilot.
const LOG_SEED: u64 = 0x6f6e_626f_6172_6421;
const MICROSECONDS_A_SECOND: u64 = 1_000_000;

/// What the log has to know of the vehicle that the autopilot flies.
#[derive(Debug, Clone)]
pub(in crate::sitl) struct Airframe {
    /// of each rotor: what one of its thrust is in torque about forward, right and down, over the longest arm
    leverage: Vec<[f64; 3]>,
    pulses: Pulses,
    /// of the thrust over the command: this share is quadratic
    quadratic: f64,
}

impl Airframe {
    fn of(settings: &Settings, parameters: &Parameters) -> Self {
        let vehicle = settings.believed();
        let arm = |rotor: &crate::vehicle::Rotor| rotor.position_m.xy().norm();
        let longest_m = vehicle.rotors.iter().map(arm).fold(f64::MIN_POSITIVE, f64::max);
        let leverage = |rotor: &crate::vehicle::Rotor| {
            let [forward_m, right_m, _] = frd_from_body(Body(rotor.position_m));
            let turn = match rotor.spin {
                Spin::Ccw => 1.0,
                Spin::Cw => -1.0,
            };
            let yaw = turn * vehicle.propulsion.torque_per_thrust_m / longest_m;
            [-right_m / longest_m, forward_m / longest_m, yaw]
        };
        let expo = if settings.autopilot.is_px4() { "THR_MDL_FAC" } else { "MOT_THST_EXPO" };
        Self {
            leverage: vehicle.rotors.iter().map(leverage).collect(),
            pulses: Pulses::of(&settings.vehicle, settings.autopilot),
            quadratic: parameters.value(expo),
        }
    }

    /// Fills in what the outputs come from.
    fn outputs(&self, moment: &mut Moment, pulses_us: &[u16; MAX_ROTORS]) {
        let count = self.leverage.len() as f64;
        for (rotor, leverage) in self.leverage.iter().enumerate().take(MAX_ROTORS) {
            moment.pulses_us[rotor] = pulses_us[rotor];
            let u = if moment.armed { self.pulses.output(pulses_us[rotor]).clamp(0.0, 1.0) } else { 0.0 };
            let share = self.quadratic * u * u + (1.0 - self.quadratic) * u;
            moment.motors[rotor] = share;
            moment.thrust += share / count;
            for (torque, lever) in moment.torque.iter_mut().zip(leverage) {
                *torque += share * lever / count;
            }
        }
    }
}

#[derive(Debug)]
enum Writer {
    Ulog(UlogWriter),
    Dataflash(DataflashWriter),
}

/// One instant, and when it is.
#[derive(Debug, Clone, Copy)]
pub(in crate::sitl) struct Now<'a> {
    pub(in crate::sitl) autopilot: &'a Autopilot,
    pub(in crate::sitl) snapshot: &'a Snapshot,
    pub(in crate::sitl) parameters: &'a Parameters,
    /// microseconds since 1970 at boot
    pub(in crate::sitl) boot_unix_us: u64,
}

impl Now<'_> {
    /// Microseconds since 1970.
    fn unix_us(&self) -> u64 {
        let since_boot = u64::try_from(self.snapshot.now.as_micros()).unwrap_or(u64::MAX);
        self.boot_unix_us.saturating_add(since_boot)
    }
}

/// Keeps the vehicle's log.
#[derive(Debug)]
pub(in crate::sitl) struct Keeper {
    store: LogStore,
    writer: Writer,
    firmware: Firmware,
    airframe: Airframe,
    esc_telemetry: bool,
    origin: Origin,
    noise: NoiseLevels,
    rng: Pcg64Mcg,
    schedule: Schedule,
    was_armed: bool,
    has_armed: bool,
    before: Option<SensorReading>,
}

impl Keeper {
    pub(in crate::sitl) fn new(settings: &Settings, parameters: &Parameters) -> Self {
        let firmware = settings.autopilot;
        let is_px4 = firmware.is_px4();
        Self {
            store: LogStore::new(is_px4),
            writer: if is_px4 {
                Writer::Ulog(UlogWriter::default())
            } else {
                Writer::Dataflash(DataflashWriter::default())
            },
            firmware,
            esc_telemetry: settings.esc_telemetry,
            airframe: Airframe::of(settings, parameters),
            origin: settings.origin,
            noise: settings.sensors.noise.scaled(settings.sensors.noise_scale),
            rng: Pcg64Mcg::seed_from_u64(settings.seed ^ LOG_SEED),
            schedule: schedule(firmware, parameters),
            was_armed: false,
            has_armed: false,
            before: None,
        }
    }

    /// The logs.
    pub(in crate::sitl) fn store(&self) -> &LogStore {
        &self.store
    }

    /// The autopilot restarts: the log ends, and PX4 reads its parameters of logging.
    pub(in crate::sitl) fn reboot(&mut self, parameters: &Parameters) {
        self.store.end();
        self.schedule = schedule(self.firmware, parameters);
        (self.was_armed, self.has_armed, self.before) = (false, false, None);
    }

    /// Takes one period of the main loop.
    pub(in crate::sitl) fn take(&mut self, now: &Now<'_>) {
        // ArduPilot looks at its parameters all the time
        if !self.firmware.is_px4() {
            self.schedule = schedule(self.firmware, now.parameters);
        }
        let seen = self.sense(now);
        let armed = now.autopilot.is_armed();
        self.open_or_end(now, armed);
        let before = self.before.replace(seen);
        let (was_armed, has_armed) = (armed, self.has_armed || armed);
        (self.was_armed, self.has_armed) = (was_armed, has_armed);
        let Some(into) = self.store.open() else { return };
        let time_us = now.snapshot.now.as_micros() as f64;
        let period = self.firmware.loop_period();
        let mut moment = Moment::of(now.autopilot, &seen, time_us, &self.origin);
        moment.gps_time = gps_time(now.unix_us());
        moment.has_origin = now.autopilot.estimator.is_warm(now.snapshot.now);
        moment.rotor_speed_rad_s = now.snapshot.shown.rotor_speed_rad_s.filter(|_| self.esc_telemetry);
        moment.rotor_count = self.airframe.leverage.len();
        if let Some(before) = before {
            moment.period_us = period.as_micros() as f64;
            let mean = |now: [f64; 3], before: [f64; 3]| {
                std::array::from_fn(|axis| 0.5 * (now[axis] + before[axis]))
            };
            let earlier = Moment::of(now.autopilot, &before, time_us, &self.origin);
            moment.mean_rates_rad_s = mean(moment.rates_rad_s, earlier.rates_rad_s);
            moment.mean_force_m_s2 = mean(moment.force_m_s2, earlier.force_m_s2);
        }
        self.airframe.outputs(&mut moment, &now.snapshot.pulses_us);
        let at = (now.snapshot.now, period);
        match &mut self.writer {
            Writer::Ulog(writer) => writer.write(into, &moment, &self.schedule, at),
            Writer::Dataflash(writer) => writer.write(into, &moment, &self.schedule, at, self.firmware),
        }
    }

    /// What the sensors show, with noise of the log's own.
    fn sense(&mut self, now: &Now<'_>) -> SensorReading {
        let mut state = self.noise.measure(&mut self.rng, &now.snapshot.shown.state);
        state.position_m += now.autopilot.estimator.shift_m();
        let force_m_s2 = self.noise.measure_force(&mut self.rng, &now.snapshot.shown.specific_force_m_s2);
        SensorReading { state, force_m_s2 }
    }

    fn open_or_end(&mut self, now: &Now<'_>, armed: bool) {
        let (begins, disarms) = (armed && !self.was_armed, !armed && self.was_armed);
        let wanted = match self.schedule.when {
            When::Never => false,
            When::Armed => armed,
            When::BootUntilDisarmed => armed || !self.has_armed,
            When::FirstArmed => armed || self.has_armed,
            When::Always => true,
        };
        let ends = disarms && matches!(self.schedule.when, When::Armed | When::BootUntilDisarmed);
        if !wanted || ends {
            self.store.end();
            return;
        }
        let is_first = !self.has_armed && self.before.is_none();
        // one that became too long is not gone on with before the next flight
        if !self.store.is_open() && (begins || is_first || self.store.all().len() == 0) {
            self.begin(now);
        }
    }

    fn begin(&mut self, now: &Now<'_>) {
        self.store.begin(now.unix_us() / MICROSECONDS_A_SECOND);
        let Some(into) = self.store.open() else { return };
        let time_us = now.snapshot.now.as_micros() as f64;
        let release = self.firmware.release();
        match &mut self.writer {
            Writer::Ulog(writer) => {
                let software = Software { major: release.major, minor: release.minor };
                writer.begin(into, time_us, software, now.parameters);
            }
            Writer::Dataflash(writer) => writer.begin(into, time_us, release, now.parameters),
        }
    }

    /// A parameter was set, at a time since boot.
    pub(in crate::sitl) fn parameter(
        &mut self,
        now: Duration,
        name: &str,
        of_type: ParameterType,
        value: f64,
    ) {
        let time_us = now.as_micros() as f64;
        let Some(into) = self.store.open() else { return };
        match &self.writer {
            Writer::Ulog(_) => UlogWriter::changed(into, name, of_type, value),
            Writer::Dataflash(_) => DataflashWriter::parameter(into, time_us, name, value),
        }
    }

    /// The vehicle said something, at a time since boot.
    pub(in crate::sitl) fn text(&mut self, now: Duration, text: &Text) {
        let time_us = now.as_micros() as f64;
        let Some(into) = self.store.open() else { return };
        match &self.writer {
            Writer::Ulog(_) => {
                // as MAVLink numbers it
                let severity = u8::try_from(text.severity as u32).unwrap_or(u8::MAX);
                UlogWriter::text(into, time_us, severity, &text.text);
            }
            Writer::Dataflash(_) => DataflashWriter::text(into, time_us, &text.text),
        }
    }
}

fn schedule(firmware: Firmware, parameters: &Parameters) -> Schedule {
    if firmware.is_px4() { Schedule::px4(parameters) } else { Schedule::ardupilot(parameters) }
}
