//! DataFlash logs: messages behind two bytes and a number, as the definitions in the log say.

use super::names::{Coordinate, coordinate, is_identity, is_secret_parameter};
use super::pass::{Kind, Pass};
use super::texts::Part;
use crate::autopilot::DATAFLASH_MARKER;
use std::collections::BTreeMap;

const DEFINITION: u8 = 128;
const DEFINITION_BYTES: usize = 89;
/// Messages whose bytes hold positions, files or names of the hardware in forms of their own.
const OPAQUE: &[&str] = &["FILE", "GRAW", "GRXH", "GRXS", "UBX1", "UBX2", "ADSB", "SBFE", "UNIT_ID", "RTC"];

/// Whether a file begins as a DataFlash log: its first message is a definition.
pub(super) fn is_one(log: &[u8]) -> bool {
    log.starts_with(&DATAFLASH_MARKER) && log.get(2) == Some(&DEFINITION)
}

struct Definition {
    name: String,
    bytes: usize,
    /// letter of the format and label of each value
    values: Vec<(u8, String)>,
}

fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// The definition that a message holds: its number, and what is so defined.
fn defined(message: &[u8]) -> Option<(u8, Definition)> {
    let labels = text(message.get(25..89)?);
    let letters = text(message.get(9..25)?);
    let values =
        letters.bytes().zip(labels.split(',').map(str::to_owned).chain(std::iter::repeat(String::new())));
    let bytes = usize::from(*message.get(4)?);
    Some((*message.get(3)?, Definition { name: text(message.get(5..9)?), bytes, values: values.collect() }))
}

/// Bytes of a value by the letter of its format.
fn bytes_of(letter: u8) -> Option<usize> {
    Some(match letter {
        b'b' | b'B' | b'M' => 1,
        b'h' | b'H' | b'c' | b'C' | b'g' => 2,
        b'i' | b'I' | b'f' | b'n' | b'e' | b'E' | b'L' => 4,
        b'd' | b'q' | b'Q' => 8,
        b'N' => 16,
        b'a' | b'Z' => 64,
        _ => return None,
    })
}

/// Walks the log; the redacted one comes out.
pub(super) fn walk(log: &[u8], pass: &mut Pass) -> Vec<u8> {
    let mut out = Vec::with_capacity(log.len());
    let mut definitions: BTreeMap<u8, Definition> = BTreeMap::new();
    let mut at = 0;
    while at < log.len() {
        let number = log
            .get(at..at + 2)
            .filter(|mark| *mark == DATAFLASH_MARKER)
            .and_then(|_| log.get(at + 2))
            .copied();
        let bytes = match number {
            Some(DEFINITION) => Some(DEFINITION_BYTES),
            Some(number) => definitions.get(&number).map(|of| of.bytes).filter(|bytes| *bytes >= 3),
            None => None,
        };
        let message = bytes.and_then(|bytes| log.get(at..at + bytes));
        let (Some(number), Some(message)) = (number, message) else {
            at += 1;
            pass.tally.unread_bytes += 1;
            continue;
        };
        at += message.len();
        if number == DEFINITION {
            if let Some((number, definition)) = defined(message) {
                definitions.insert(number, definition);
            }
            pass.tally.kept += 1;
            out.extend_from_slice(message);
        } else if let Some(redacted) = definitions.get(&number).and_then(|of| of.redacted(message, pass)) {
            pass.tally.kept += 1;
            out.extend_from_slice(&redacted);
        } else {
            let name =
                definitions.get(&number).map_or_else(|| format!("message {number}"), |of| of.name.clone());
            pass.leave_out(name);
        }
    }
    out
}

impl Definition {
    /// A message without what is not to be shared; `None` where it is left out.
    fn redacted(&self, message: &[u8], pass: &mut Pass) -> Option<Vec<u8>> {
        if OPAQUE.contains(&self.name.as_str()) {
            return None;
        }
        let mut out = message.to_vec();
        let (mut at, mut named, mut pieces) = (3, String::new(), None);
        for (letter, label) in &self.values {
            // what follows a letter that is not known cannot be told
            let size = bytes_of(*letter)?;
            let value = out.get_mut(at..at + size)?;
            at += size;
            let of = coordinate(label).or_else(|| (*letter == b'L').then(|| by_letter(label)));
            match (letter, of) {
                (b'N', _) => named = text(value),
                // a long text comes in pieces with numbers
                (b'B', _) if label == "Seq" => pieces = value.first().copied(),
                (b'L' | b'i', Some(of)) => pass.move_in((of, Kind::E7), label, value),
                (b'f' | b'd', Some(of)) => pass.move_in((of, Kind::Degrees), label, value),
                (b'f' | b'd', None) if self.name == "PARM" && is_secret_parameter(&named) => {
                    pass.empty(|| named.clone(), value)
                }
                _ if is_identity(label) => pass.empty(|| format!("{}.{label}", self.name), value),
                (b'Z', _) => {
                    let goes_on = pieces.is_some() && value.last().is_some_and(|last| *last != 0);
                    let part = Part { is_continued: pieces.is_some_and(|piece| piece > 0), goes_on };
                    pass.cover(|| format!("words of {}.{label}", self.name), value, part);
                }
                _ => {}
            }
        }
        Some(out)
    }
}

/// A coordinate of a label that says which only within a word.
fn by_letter(label: &str) -> Coordinate {
    if label.to_ascii_lowercase().contains("lat") { Coordinate::Latitude } else { Coordinate::Longitude }
}
