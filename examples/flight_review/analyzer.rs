//! The analyzer: it collects the messages of its topics, and at the end has their log screened.

use super::service::{
    Analyzer, AnomalyKind, DataMessage, Diagnostic, FlattenedField, FlattenedFormat, Metadata, Severity,
};
use mavid::draft::Given;
use mavid::screen::{Bounds, Finding, Gravity, ScreenSettings, screen};

/// What the findings need: motion, outputs, states. Of topics that a log does not have, nothing comes.
const TOPICS: &[&str] = &[
    "actuator_controls_0",
    "actuator_motors",
    "actuator_outputs",
    "battery_status",
    "sensor_combined",
    "vehicle_acceleration",
    "vehicle_angular_velocity",
    "vehicle_attitude",
    "vehicle_land_detected",
    "vehicle_local_position",
    "vehicle_status",
    "vehicle_thrust_setpoint",
    "vehicle_torque_setpoint",
];
/// Quantities of findings, and the topic and field in which a service shows them.
const FIELDS: &[(&str, &str, &str)] = &[("actuator_command", "actuator_outputs", "output")];
/// Bytes of messages that are kept: a log of more is screened as far as they go.
const MOST_BYTES: usize = 64 << 20;

/// Screens a multirotor's log with mavid.
pub struct Multirotor {
    log: Vec<u8>,
    start_us: u64,
    /// topic and instance of each subscription, by its number
    known: Vec<(String, u8)>,
    settings: ScreenSettings,
}

impl Multirotor {
    /// `mass_kg`: of the vehicle, where the service knows it; effects are searched then.
    pub fn new(metadata: &Metadata, mass_kg: Option<f64>) -> Self {
        let mut log = b"ULog\x01\x12\x35\x01".to_vec();
        log.extend(metadata.start_timestamp_us.to_le_bytes());
        for (name, value) in &metadata.parameters {
            let key = format!("float {name}");
            // names are shorter than 256 letters, and parameters are single floats or small whole numbers
            let length = u8::try_from(key.len()).unwrap_or(u8::MAX);
            #[allow(clippy::cast_possible_truncation, reason = "a parameter was a float before")]
            let value = (*value as f32).to_le_bytes();
            push(&mut log, b'P', &[&[length], key.as_bytes(), &value]);
        }
        let vehicle = mass_kg.map(|mass_kg| Given { mass_kg, size_m: None, frame: None });
        let settings = ScreenSettings { vehicle, bounds: Bounds::default() };
        Self { log, start_us: metadata.start_timestamp_us, known: Vec::new(), settings }
    }

    /// Number of a message's subscription; the first message of a topic defines it.
    fn subscription(&mut self, message: &DataMessage) -> Option<u16> {
        let name = &message.flattened_format.message_name;
        let is_same = |(known, instance): &(String, u8)| known == name && *instance == message.multi_id;
        let place = self.known.iter().position(is_same);
        let number = u16::try_from(place.unwrap_or(self.known.len())).ok()?;
        if place.is_none() {
            if !self.known.iter().any(|(known, _)| known == name) {
                push(&mut self.log, b'F', &[definition(message.flattened_format).as_bytes()]);
            }
            push(&mut self.log, b'A', &[&[message.multi_id], &number.to_le_bytes(), name.as_bytes()]);
            self.known.push((name.clone(), message.multi_id));
        }
        Some(number)
    }

    fn diagnostic(&self, finding: Finding) -> Diagnostic {
        let since_us = |time_s: f64| {
            let since = std::time::Duration::try_from_secs_f64(time_s.max(0.0)).unwrap_or_default();
            u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
        };
        let stamp = |time_s: f64| self.start_us.saturating_add(since_us(time_s));
        let (from_s, to_s) = finding.span_s.unwrap_or((0.0, 0.0));
        let anchor = finding.at.and_then(|at| {
            let (_, topic, field) = FIELDS.iter().find(|(quantity, ..)| *quantity == at.quantity)?;
            Some(((*topic).to_owned(), format!("{field}[{}]", at.channel)))
        });
        Diagnostic {
            id: finding.id.to_owned(),
            summary: finding.sentence,
            severity: match finding.gravity {
                Gravity::Info => Severity::Info,
                Gravity::Warning => Severity::Warning,
                Gravity::Critical => Severity::Critical,
            },
            kind: match finding.span_s {
                Some(_) => AnomalyKind::Region { end_timestamp_us: stamp(to_s) },
                None => AnomalyKind::Point,
            },
            timestamp_us: stamp(from_s),
            anchor,
            evidence: finding.amounts.into_iter().map(|of| (of.name, of.value, of.unit.to_owned())).collect(),
        }
    }
}

impl Analyzer for Multirotor {
    fn id(&self) -> &str {
        "mavid"
    }

    fn description(&self) -> &str {
        "Outputs that leave the mixer, a balance that is off, and effects that the vehicle's model lacks"
    }

    fn required_topics(&self) -> &[&str] {
        TOPICS
    }

    fn on_message(&mut self, message: &DataMessage) {
        if self.log.len() + message.data.len() > MOST_BYTES {
            return;
        }
        if let Some(number) = self.subscription(message) {
            push(&mut self.log, b'D', &[&number.to_le_bytes(), message.data]);
        }
    }

    fn finish(self: Box<Self>) -> Vec<Diagnostic> {
        // bytes that hold nothing to look at give no diagnostic
        let Ok(screening) = screen(&self.log, &self.settings) else { return Vec::new() };
        screening.findings.into_iter().map(|finding| self.diagnostic(finding)).collect()
    }
}

/// Adds a message; one that is longer than a log can hold is left out.
fn push(log: &mut Vec<u8>, kind: u8, parts: &[&[u8]]) {
    if let Ok(length) = u16::try_from(parts.iter().map(|part| part.len()).sum::<usize>()) {
        log.extend(length.to_le_bytes());
        log.push(kind);
        parts.iter().for_each(|part| log.extend(*part));
    }
}

/// The definition of a format by its flat fields. Fields of nested messages are padding: no finding needs them.
fn definition(flat: &FlattenedFormat) -> String {
    let mut text = format!("{}:", flat.message_name);
    let (mut at, mut paddings) = (0, 0);
    let mut fields = flat.fields.iter().filter(|field| !field.flattened_field_name.contains('.')).peekable();
    while let Some(FlattenedField { flattened_field_name, field_type, offset }) = fields.next() {
        if *offset > at {
            text.push_str(&format!("uint8_t[{}] _padding{paddings};", offset - at));
            paddings += 1;
        }
        let name = flattened_field_name.split('[').next().unwrap_or_default();
        let mut count = 1;
        let is_next = |next: &&FlattenedField| {
            next.flattened_field_name.strip_prefix(name).is_some_and(|rest| rest.starts_with('['))
        };
        let is_array = flattened_field_name.contains('[');
        while is_array && fields.next_if(is_next).is_some() {
            count += 1;
        }
        let array = if is_array { format!("[{count}]") } else { String::new() };
        text.push_str(&format!("{field_type}{array} {name};"));
        at = offset + count * size_of(field_type);
    }
    text
}

fn size_of(kind: &str) -> u16 {
    match kind {
        "int16_t" | "uint16_t" => 2,
        "int32_t" | "uint32_t" | "float" => 4,
        "int64_t" | "uint64_t" | "double" => 8,
        _ => 1,
    }
}
