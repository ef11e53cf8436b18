//! ArduPilot's format: messages that begin with a marker and their number, defined by messages of the same kind.

use super::ulog_topics::SECONDS_A_MINUTE;
use std::time::Duration;

use super::bytes::Kind;
use super::dataflash_forms::{
    ARM, ATT, BARO, BAT, ESC, EV, FMT, FMTU, FORMS, Form, GPS, IMU, MODE, MSG, MULT, MULTIPLIERS, PARM, PSCD,
    PSCE, PSCN, RATE, RCOU, UNIT, UNITS, XKF1,
};
use super::frames::euler_deg;
use super::moment::Moment;
use super::schedule::Schedule;
use crate::autopilot::{DATAFLASH_MARKER, Release};
use crate::physics::MAX_ROTORS;
use crate::sitl::parameters::Parameters;
use crate::sitl::{Firmware, Mode};

/// Channels of RCOU.
const CHANNELS: usize = 14;
/// LogEvent: armed, disarmed, landed, airborne.
const EVENT_ARMED: [f64; 2] = [11.0, 10.0];
const EVENT_LANDED: [f64; 2] = [28.0, 18.0];

/// A value of a message.
#[derive(Debug, Clone, Copy)]
enum Value<'a> {
    Number(f64),
    Text(&'a str),
}

/// Bytes of a text of this letter.
fn letters(letter: char) -> Option<usize> {
    match letter {
        'n' => Some(4),
        'N' => Some(16),
        'Z' => Some(64),
        _ => None,
    }
}

/// How a number of this letter is stored, and what one of it is in the field's unit.
fn number(letter: char) -> (Kind, f64) {
    match letter {
        'b' => (Kind::I8, 1.0),
        'h' => (Kind::I16, 1.0),
        'H' => (Kind::U16, 1.0),
        'i' => (Kind::I32, 1.0),
        'I' => (Kind::U32, 1.0),
        'Q' => (Kind::U64, 1.0),
        'f' => (Kind::F32, 1.0),
        'd' => (Kind::F64, 1.0),
        'c' => (Kind::I16, 1e-2),
        'C' => (Kind::U16, 1e-2),
        'e' => (Kind::I32, 1e-2),
        'E' => (Kind::U32, 1e-2),
        'L' => (Kind::I32, 1e-7),
        // B, M
        _ => (Kind::U8, 1.0),
    }
}

/// Bytes of a message with its header.
fn length(form: &Form) -> usize {
    let bytes = |letter: char| {
        letters(letter).unwrap_or_else(|| {
            let mut stored = Vec::new();
            number(letter).0.put(&mut stored, 0.0);
            stored.len()
        })
    };
    DATAFLASH_MARKER.len() + 1 + form.format.chars().map(bytes).sum::<usize>()
}

fn put(into: &mut Vec<u8>, form: &Form, values: &[Value<'_>]) {
    into.extend(DATAFLASH_MARKER);
    into.push(form.number);
    for (letter, value) in form.format.chars().zip(values) {
        match (letters(letter), value) {
            (Some(count), Value::Text(text)) => {
                let mut bytes: Vec<u8> = text.bytes().take(count).collect();
                bytes.resize(count, 0);
                into.extend(bytes);
            }
            (None, Value::Number(value)) => {
                let (kind, one) = number(letter);
                kind.put(into, value / one);
            }
            // a text where a number belongs, or the other way round: nought of the right length
            (Some(count), Value::Number(_)) => into.extend(std::iter::repeat_n(0, count)),
            (None, Value::Text(_)) => number(letter).0.put(into, 0.0),
        }
    }
}

fn numbers<const N: usize>(into: &mut Vec<u8>, form: &Form, values: [f64; N]) {
    put(into, form, &values.map(Value::Number));
}

/// Writes ArduPilot's log.
#[derive(Debug, Default)]
pub(super) struct DataflashWriter {
    last_state: Option<(bool, bool, Mode)>,
}

impl DataflashWriter {
    /// Definitions and parameters, at a time since boot in microseconds.
    pub(super) fn begin(
        &mut self,
        into: &mut Vec<u8>,
        time_us: f64,
        release: Release,
        parameters: &Parameters,
    ) {
        use Value::{Number, Text};
        self.last_state = None;
        for form in FORMS {
            let head = [f64::from(form.number), length(form) as f64].map(Number);
            let tail = [form.name, form.format, form.fields].map(Text);
            put(into, &FMT, &[&head[..], &tail[..]].concat());
        }
        let time = Number(time_us);
        for (letter, label) in UNITS {
            put(into, &UNIT, &[time, Number(f64::from(*letter)), Text(label)]);
        }
        for (letter, multiplier) in MULTIPLIERS {
            numbers(into, &MULT, [time_us, f64::from(*letter), *multiplier]);
        }
        for form in FORMS {
            let multipliers = form.multipliers();
            put(into, &FMTU, &[time, Number(f64::from(form.number)), Text(form.units), Text(&multipliers)]);
        }
        let Release { major, minor } = release;
        put(into, &MSG, &[time, Text(&format!("ArduCopter V{major}.{minor}.0 (mavid)"))]);
        for (name, _, value) in parameters.all() {
            Self::parameter(into, time_us, name, value);
        }
    }

    /// A parameter's value.
    pub(super) fn parameter(into: &mut Vec<u8>, time_us: f64, name: &str, value: f64) {
        let [time, value, default] = [time_us, value, f64::NAN].map(Value::Number);
        put(into, &PARM, &[time, Value::Text(name), value, default]);
    }

    /// What the vehicle said.
    pub(super) fn text(into: &mut Vec<u8>, time_us: f64, text: &str) {
        put(into, &MSG, &[Value::Number(time_us), Value::Text(text)]);
    }

    /// All that is due at one instant.
    pub(super) fn write(
        &mut self,
        into: &mut Vec<u8>,
        at: &Moment,
        schedule: &Schedule,
        (now, period): (Duration, Duration),
        firmware: Firmware,
    ) {
        let rates = schedule.rates();
        let time_us = at.time_us;
        self.states(into, at, firmware);
        if rates.imu.is_due(now, period) {
            let ([gx, gy, gz], [ax, ay, az]) = (at.rates_rad_s, at.force_m_s2);
            let hz = if at.period_us > 0.0 { 1e6 / at.period_us } else { 0.0 };
            numbers(into, &IMU, [time_us, 0.0, gx, gy, gz, ax, ay, az, hz, hz]);
        }
        if rates.attitude.is_due(now, period) {
            attitude(into, at);
        }
        if rates.outputs.is_due(now, period) {
            let mut values = [0.0; CHANNELS + 1];
            values[0] = time_us;
            for (value, pulse_us) in values[1..=MAX_ROTORS].iter_mut().zip(at.pulses_us) {
                *value = f64::from(pulse_us);
            }
            numbers(into, &RCOU, values);
        }
        if let Some(speeds) = at.rotor_speed_rad_s.filter(|_| rates.speeds.is_due(now, period)) {
            for (rotor, speed) in speeds.iter().enumerate().take(at.rotor_count) {
                let rpm = speed * SECONDS_A_MINUTE / std::f64::consts::TAU;
                numbers(into, &ESC, [time_us, rotor as f64, rpm, at.battery_v]);
            }
        }
        if rates.estimate.is_due(now, period) && at.has_origin {
            let [roll, pitch, yaw] = euler_deg(at.attitude);
            let ([vn, ve, vd], [pn, pe, pd]) = (at.velocity_m_s, at.position_m);
            numbers(into, &XKF1, [time_us, 0.0, roll, pitch, yaw, vn, ve, vd, vd, pn, pe, pd]);
        }
        if rates.satellites.is_due(now, period) {
            satellites(into, at);
            numbers(into, &BARO, [time_us, 0.0, at.on_earth[2]]);
        }
        if rates.targets.is_due(now, period) && at.armed {
            for (axis, form) in [PSCN, PSCE, PSCD].iter().enumerate() {
                let wanted = [at.position_wanted_m, at.velocity_wanted_m_s, at.acceleration_wanted_m_s2];
                let [place, speed, push] = wanted.map(|vector| vector[axis]);
                let own = [at.position_m[axis], at.velocity_m_s[axis]];
                numbers(into, form, [time_us, place, own[0], speed, own[1], push, 0.0]);
            }
        }
        if rates.battery.is_due(now, period) {
            numbers(into, &BAT, [time_us, 0.0, at.battery_v]);
        }
    }

    /// States, when they change.
    fn states(&mut self, into: &mut Vec<u8>, at: &Moment, firmware: Firmware) {
        let state = (at.armed, at.landed, at.mode);
        let before = self.last_state.replace(state);
        let event = |into: &mut Vec<u8>, [off, on]: [f64; 2], is: bool| {
            numbers(into, &EV, [at.time_us, if is { on } else { off }]);
        };
        if before.is_none_or(|(armed, ..)| armed != at.armed) {
            numbers(into, &ARM, [at.time_us, f64::from(u8::from(at.armed)), 0.0, 0.0, 0.0]);
            event(into, EVENT_ARMED, at.armed);
        }
        if before.is_none_or(|(_, landed, _)| landed != at.landed) {
            event(into, EVENT_LANDED, at.landed);
        }
        if before.is_none_or(|(.., mode)| mode != at.mode) {
            let number = f64::from(at.mode.custom_mode(firmware).unwrap_or_default());
            numbers(into, &MODE, [at.time_us, number, number, 0.0]);
        }
    }
}

/// A fix in three dimensions by fourteen satellites.
fn satellites(into: &mut Vec<u8>, at: &Moment) {
    const FIX_3D: f64 = 3.0;
    const COUNT: f64 = 14.0;
    let ([vn, ve, vd], [latitude, longitude, height_m]) = (at.velocity_m_s, at.on_earth);
    let (speed, course) = (vn.hypot(ve), ve.atan2(vn).to_degrees().rem_euclid(360.0));
    let [week, of_week_ms] = at.gps_time;
    let [time_us, instance] = [at.time_us, 0.0];
    let fix = [
        time_us, instance, FIX_3D, of_week_ms, week, COUNT, latitude, longitude, height_m, speed, course, vd,
    ];
    numbers(into, &GPS, fix);
}

/// Attitude and rates, and what was asked of them.
fn attitude(into: &mut Vec<u8>, at: &Moment) {
    let wanted = if at.armed { at.attitude_wanted } else { at.attitude };
    let ([roll, pitch, yaw], [to_roll, to_pitch, to_yaw]) = (euler_deg(at.attitude), euler_deg(wanted));
    numbers(into, &ATT, [at.time_us, to_roll, roll, to_pitch, pitch, to_yaw, yaw, 1.0]);
    if !at.armed {
        return;
    }
    let [p, q, r] = at.rates_rad_s.map(f64::to_degrees);
    let [to_p, to_q, to_r] = at.rates_wanted_rad_s.map(f64::to_degrees);
    let ([x, y, z], thrust) = (at.torque, at.thrust);
    // vertical acceleration, up
    let up_m_s2 = -at.force_m_s2[2];
    numbers(into, &RATE, [at.time_us, to_p, p, x, to_q, q, y, to_r, r, z, up_m_s2, up_m_s2, thrust]);
}
