//! ULog: messages with a length and a kind; topics as their definitions say.

use super::names::{coordinate, is_identity, is_secret_parameter, is_suspicious};
use super::pass::{Kind, Pass};
use super::texts::Part;
use crate::autopilot::{ULOG_DEEPEST, ULOG_HEAD_BYTES, ULOG_MAGIC};
use std::collections::BTreeMap;

/// Length and kind before each message.
const HEAD_BYTES: usize = 3;
/// What the words of the autopilot are called.
const TEXT: &str = "words of texts";
/// Topics whose bytes hold positions or names of the hardware in forms of their own.
const OPAQUE: &[&str] = &[
    "gps_dump",
    "gps_inject_data",
    "gps_raw",
    "open_drone_id",
    "transponder_report",
    "adsb",
    "ulog_stream",
    "mavlink_tunnel",
    "mavlink_log",
    "log_message",
    "vehicle_command",
    "device_information",
    "rtk",
];

/// Whether a file begins as a ULog.
pub(super) fn is_one(log: &[u8]) -> bool {
    log.starts_with(&ULOG_MAGIC)
}

/// A field of a definition.
#[derive(Debug, Clone)]
struct Field {
    kind: String,
    count: usize,
    name: String,
}

#[derive(Default)]
struct Schema {
    formats: BTreeMap<String, Vec<Field>>,
    /// topic of each number
    topics: BTreeMap<u16, String>,
    /// topics that are left out
    left_out: BTreeMap<u16, String>,
}

/// Walks the log; the redacted one comes out. What follows a break in the messages is not read.
pub(super) fn walk(log: &[u8], pass: &mut Pass) -> Vec<u8> {
    let mut out = log.get(..ULOG_HEAD_BYTES).unwrap_or_default().to_vec();
    let mut schema = Schema::default();
    let mut at = ULOG_HEAD_BYTES.min(log.len());
    while let Some(&[low, high, kind]) = log.get(at..at + HEAD_BYTES) {
        let length = usize::from(u16::from_le_bytes([low, high]));
        let Some(body) = log.get(at + HEAD_BYTES..at + HEAD_BYTES + length) else { break };
        if !b"BFIMPQADLCSOR".contains(&kind) {
            break;
        }
        at += HEAD_BYTES + length;
        match schema.redacted(kind, body, pass) {
            Some(body) => {
                pass.tally.kept += 1;
                out.extend_from_slice(&[low, high, kind]);
                out.extend_from_slice(&body);
            }
            None => pass.leave_out(schema.name_of(kind, body)),
        }
    }
    pass.tally.unread_bytes += (log.len() - at) as u64;
    out
}

impl Schema {
    fn redacted(&mut self, kind: u8, body: &[u8], pass: &mut Pass) -> Option<Vec<u8>> {
        let mut out = body.to_vec();
        match kind {
            // offsets of appended data no longer hold: it is read as what follows
            b'B' => out.get_mut(16..40).into_iter().for_each(|offsets| offsets.fill(0)),
            b'F' => self.define(body),
            b'A' => self.subscribe(body)?,
            b'D' => {
                let number = u16::from_le_bytes([*body.first()?, *body.get(1)?]);
                if self.left_out.contains_key(&number) {
                    return None;
                }
                let topic = self.topics.get(&number)?.clone();
                self.topic(&topic, out.get_mut(2..)?, pass, ULOG_DEEPEST);
            }
            b'I' => {
                let (kind, name, value) = keyed(body.first().copied()?, body.get(1..)?)?;
                if is_identity(name) || (kind.starts_with("char") && is_suspicious_info(name, value)) {
                    return None;
                }
            }
            b'P' => secret(body, 0, &mut out, pass)?,
            b'Q' => secret(body, 1, &mut out, pass)?,
            // texts of the boot, of performance counters, of faults
            b'M' => return None,
            b'L' => pass.cover(|| TEXT.to_owned(), out.get_mut(9..)?, Part::default()),
            b'C' => pass.cover(|| TEXT.to_owned(), out.get_mut(11..)?, Part::default()),
            _ => {}
        }
        Some(out)
    }

    /// What a message is called: its topic, or what it holds.
    fn name_of(&self, kind: u8, body: &[u8]) -> String {
        let number = |at: usize| Some(u16::from_le_bytes([*body.get(at)?, *body.get(at + 1)?]));
        match kind {
            b'D' => number(0)
                .and_then(|number| self.left_out.get(&number))
                .cloned()
                .unwrap_or_else(|| "data without a topic".to_owned()),
            b'A' => "subscription to such a topic".to_owned(),
            b'I' => "information on the hardware".to_owned(),
            b'M' => "texts of the boot".to_owned(),
            _ => "damaged message".to_owned(),
        }
    }

    fn define(&mut self, body: &[u8]) {
        let text = String::from_utf8_lossy(body);
        let Some((name, fields)) = text.split_once(':') else { return };
        let fields = fields.split(';').filter_map(|field| {
            let (kind, name) = field.trim().split_once(' ')?;
            let (kind, count) = match kind.split_once('[') {
                Some((kind, count)) => (kind, count.trim_end_matches(']').parse().ok()?),
                None => (kind, 1),
            };
            Some(Field { kind: kind.to_owned(), count, name: name.to_owned() })
        });
        self.formats.insert(name.to_owned(), fields.collect());
    }

    fn subscribe(&mut self, body: &[u8]) -> Option<()> {
        let number = u16::from_le_bytes([*body.get(1)?, *body.get(2)?]);
        let name = String::from_utf8_lossy(body.get(3..)?).into_owned();
        if OPAQUE.iter().any(|opaque| name.starts_with(opaque)) {
            self.left_out.insert(number, name);
            return None;
        }
        self.topics.insert(number, name);
        Some(())
    }

    /// Bytes of a type; `None` of one that is not defined.
    fn bytes_of(&self, kind: &str, depth: usize) -> Option<usize> {
        match kind {
            "int8_t" | "uint8_t" | "bool" | "char" => Some(1),
            "int16_t" | "uint16_t" => Some(2),
            "int32_t" | "uint32_t" | "float" => Some(4),
            "int64_t" | "uint64_t" | "double" => Some(8),
            _ if depth == 0 => None,
            inner => self
                .formats
                .get(inner)?
                .iter()
                .map(|field| Some(field.count * self.bytes_of(&field.kind, depth - 1)?))
                .sum(),
        }
    }

    /// Redacts the bytes of a topic, field by field.
    fn topic(&self, name: &str, bytes: &mut [u8], pass: &mut Pass, depth: usize) {
        let Some(fields) = self.formats.get(name).filter(|_| depth > 0) else { return };
        let mut at = 0;
        for field in fields {
            let Some(size) = self.bytes_of(&field.kind, depth - 1) else { return };
            for _ in 0..field.count {
                // padding at the end is not written
                let Some(value) = bytes.get_mut(at..at + size) else { return };
                at += size;
                if self.formats.contains_key(&field.kind) {
                    self.topic(&field.kind, value, pass, depth - 1);
                } else if let Some(of) = coordinate(&field.name) {
                    match field.kind.as_str() {
                        "int32_t" => pass.move_in((of, Kind::E7), &field.name, value),
                        "float" | "double" => pass.move_in((of, Kind::Degrees), &field.name, value),
                        _ => {}
                    }
                } else if is_identity(&field.name) {
                    pass.empty(|| format!("{name}.{}", field.name), value);
                }
            }
        }
    }
}

/// A key and its value: `type name`, and what follows.
fn keyed(length: u8, rest: &[u8]) -> Option<(&str, &str, &[u8])> {
    let (key, value) = rest.split_at_checked(usize::from(length))?;
    let (kind, name) = std::str::from_utf8(key).ok()?.split_once(' ')?;
    Some((kind, name, value))
}

/// Versions of the software are known to all; other information that looks like a number of the hardware is not.
fn is_suspicious_info(name: &str, value: &[u8]) -> bool {
    !name.starts_with("ver_sw")
        && !name.starts_with("ver_hw")
        && is_suspicious(&String::from_utf8_lossy(value))
}

/// Empties the value of a parameter that is not to be shared; `before` bytes stand before its key.
fn secret(body: &[u8], before: usize, out: &mut [u8], pass: &mut Pass) -> Option<()> {
    let length = *body.get(before)?;
    let (_, name, _) = keyed(length, body.get(before + 1..)?)?;
    if is_secret_parameter(name) {
        pass.empty(|| name.to_owned(), out.get_mut(before + 1 + usize::from(length)..)?);
    }
    Some(())
}
