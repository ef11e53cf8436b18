//! PX4's format: definitions, then messages.

use std::time::Duration;

use super::bytes::Kind;
use super::moment::Moment;
use super::schedule::{Every, Schedule};
use super::ulog_topics::{ESC_FIELDS, ESC_REPORT, Field, STATES, TOPICS};
use crate::autopilot::{ParameterType, ULOG_FLAG_BYTES};
use crate::sitl::parameters::Parameters;

/// Magic and version 1.
const BEGIN: [u8; 8] = [0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 0x01];
/// Letters of messages.
mod letter {
    pub(super) const FLAGS: u8 = b'B';
    pub(super) const FORMAT: u8 = b'F';
    pub(super) const INFORMATION: u8 = b'I';
    pub(super) const PARAMETER: u8 = b'P';
    pub(super) const SUBSCRIBE: u8 = b'A';
    pub(super) const DATA: u8 = b'D';
    pub(super) const TEXT: u8 = b'L';
}

/// How a field of this type is stored.
fn kind(name: &str) -> Kind {
    match name {
        "int8_t" => Kind::I8,
        "int16_t" => Kind::I16,
        "uint16_t" => Kind::U16,
        "int32_t" => Kind::I32,
        "uint32_t" => Kind::U32,
        "uint64_t" => Kind::U64,
        "float" => Kind::F32,
        "double" => Kind::F64,
        // uint8_t, bool and char
        _ => Kind::U8,
    }
}

/// The numbers of a field, one after the other.
fn kinds((of_type, count, _): Field) -> Vec<Kind> {
    let one: Vec<Kind> = match of_type {
        ESC_REPORT => ESC_FIELDS.iter().map(|(of_type, ..)| kind(of_type)).collect(),
        _ => vec![kind(of_type)],
    };
    one.repeat(count)
}

fn message(into: &mut Vec<u8>, kind: u8, body: &[u8]) {
    let Ok(length) = u16::try_from(body.len()) else { return };
    into.extend(length.to_le_bytes());
    into.push(kind);
    into.extend_from_slice(body);
}

/// `type name`, its length before it.
fn keyed(of_type: &str, name: &str) -> Vec<u8> {
    let key = format!("{of_type} {name}");
    let mut body = vec![u8::try_from(key.len()).unwrap_or(u8::MAX)];
    body.extend(key.bytes());
    body
}

fn information(into: &mut Vec<u8>, of_type: &str, name: &str, value: &[u8]) {
    let mut body = keyed(of_type, name);
    body.extend_from_slice(value);
    message(into, letter::INFORMATION, &body);
}

fn format_of(name: &str, fields: impl Iterator<Item = Field>) -> String {
    let field = |(of_type, count, name): (&str, usize, &str)| match count {
        1 => format!("{of_type} {name};"),
        _ => format!("{of_type}[{count}] {name};"),
    };
    format!("{name}:{}", fields.map(field).collect::<String>())
}

/// What PX4 says of itself at the beginning of a log.
#[derive(Debug, Clone, Copy)]
pub(super) struct Software {
    pub(super) major: u8,
    pub(super) minor: u8,
}

/// Writes PX4's log.
#[derive(Debug, Default)]
pub(super) struct UlogWriter {
    values: Vec<f64>,
    body: Vec<u8>,
    /// armed, landed and mode, as they were written last
    last_state: Option<(bool, bool, crate::sitl::Mode)>,
}

impl UlogWriter {
    /// Definitions and parameters, at a time since boot in microseconds.
    pub(super) fn begin(
        &mut self,
        into: &mut Vec<u8>,
        time_us: f64,
        software: Software,
        parameters: &Parameters,
    ) {
        self.last_state = None;
        into.extend(BEGIN);
        Kind::U64.put(into, time_us);
        message(into, letter::FLAGS, &[0; ULOG_FLAG_BYTES]);
        information(into, "char[3]", "sys_name", b"PX4");
        information(into, "char[10]", "ver_hw", b"MAVID_SITL");
        let release = [255, 0, software.minor, software.major];
        information(into, "uint32_t", "ver_sw_release", &release);
        let report = format_of(ESC_REPORT, ESC_FIELDS.iter().copied());
        message(into, letter::FORMAT, report.as_bytes());
        for topic in TOPICS {
            message(into, letter::FORMAT, format_of(topic.name, topic.all_fields()).as_bytes());
        }
        for (name, of_type, value) in parameters.all() {
            parameter(into, name, of_type, value);
        }
        for (number, topic) in (0_u16..).zip(TOPICS) {
            let mut body = vec![0];
            body.extend(number.to_le_bytes());
            body.extend(topic.name.bytes());
            message(into, letter::SUBSCRIBE, &body);
        }
    }

    /// A parameter that changed.
    pub(super) fn changed(into: &mut Vec<u8>, name: &str, of_type: ParameterType, value: f64) {
        parameter(into, name, of_type, value);
    }

    /// What the vehicle said.
    pub(super) fn text(into: &mut Vec<u8>, time_us: f64, severity: u8, text: &str) {
        let mut body = vec![b'0' + severity.min(7)];
        Kind::U64.put(&mut body, time_us);
        body.extend(text.bytes());
        message(into, letter::TEXT, &body);
    }

    /// All that is due at one instant.
    pub(super) fn write(
        &mut self,
        into: &mut Vec<u8>,
        at: &Moment,
        schedule: &Schedule,
        (now, period): (Duration, Duration),
    ) {
        let state = (at.armed, at.landed, at.mode);
        let has_changed = self.last_state.replace(state) != Some(state);
        for (number, topic) in (0_u16..).zip(TOPICS) {
            let every = schedule.topic(topic.default, topic.identification);
            let is_state = STATES.contains(&topic.name);
            let every = if is_state { topic.default } else { every };
            let due = every.is_due(now, period) || is_state && has_changed;
            if every == Every::Never || !due {
                continue;
            }
            self.values.clear();
            (topic.fill)(at, &mut self.values);
            if self.values.is_empty() {
                continue;
            }
            self.body.clear();
            self.body.extend(number.to_le_bytes());
            let kinds = topic.all_fields().flat_map(kinds);
            for (kind, value) in kinds.zip(std::iter::once(&at.time_us).chain(&self.values)) {
                kind.put(&mut self.body, *value);
            }
            message(into, letter::DATA, &self.body);
        }
    }
}

fn parameter(into: &mut Vec<u8>, name: &str, of_type: ParameterType, value: f64) {
    let (of_type, kind) = match of_type {
        ParameterType::Real32 => ("float", Kind::F32),
        _ => ("int32_t", Kind::I32),
    };
    let mut body = keyed(of_type, name);
    kind.put(&mut body, value);
    message(into, letter::PARAMETER, &body);
}
