//! Where the fields of a message stand in its bytes.

use crate::autopilot::ULOG_DEEPEST;
use std::collections::HashMap;

use super::definition::{Definition, FieldType};
use super::number::{NumberType, array};

/// A message is no longer: its length is sixteen bits.
const MOST_BYTES: usize = u16::MAX as usize;
/// Name of the field that says when.
const STAMP: &str = "timestamp";

/// Where the fields of a message stand in its bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    spans: Vec<Span>,
    bytes: usize,
    bytes_without_padding: usize,
    stamp_offset: Option<usize>,
}

/// A number, or an array of them.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Span {
    /// `esc[0].esc_rpm`; of an array without its index
    path: String,
    number: NumberType,
    count: Option<usize>,
    offset: usize,
}

/// One number of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell {
    /// byte offset
    pub offset: usize,
    /// type
    pub number: NumberType,
}

impl Cell {
    /// Its value in a message; NaN where the message ends before.
    #[inline]
    #[must_use]
    pub fn read(&self, message: &[u8]) -> f64 {
        self.number.read(message, self.offset)
    }

    /// Its value to the last bit, where it is a 64-bit number of no sign.
    #[inline]
    #[must_use]
    pub fn whole(&self, message: &[u8]) -> Option<u64> {
        let bytes = array(message, self.offset).filter(|_| self.number == NumberType::U64);
        bytes.map(u64::from_le_bytes)
    }
}

impl Layout {
    /// The layout of a definition; `None` where one that it uses is missing, or it is longer than a message may be.
    pub(super) fn of(definition: &Definition, all: &HashMap<String, Definition>) -> Option<Self> {
        let mut spans = Vec::new();
        let bytes = spread(definition, all, "", 0, ULOG_DEEPEST, &mut spans)?;
        let padding = definition.fields.last().filter(|last| last.is_padding()).and(spans.last());
        let bytes_without_padding = padding.map_or(bytes, |padding| padding.offset);
        let is_stamp =
            |span: &&Span| span.path == STAMP && span.number == NumberType::U64 && span.count.is_none();
        let stamp_offset = spans.iter().find(is_stamp).map(|span| span.offset);
        Some(Self { spans, bytes, bytes_without_padding, stamp_offset })
    }

    /// Entries that it takes in memory.
    pub(super) fn spans(&self) -> usize {
        self.spans.len()
    }

    /// Bytes of a message of this layout, least and most: a writer leaves the padding at its end out.
    pub(super) fn lengths(&self) -> (usize, usize) {
        (self.bytes_without_padding, self.bytes)
    }

    /// Where the stamp begins; `None` where there is none.
    pub(super) fn stamp_offset(&self) -> Option<usize> {
        self.stamp_offset
    }

    /// The number of a path such as `esc[0].esc_rpm` or `xyz[2]`.
    #[must_use]
    pub fn cell(&self, path: &str) -> Option<Cell> {
        let whole = self.spans.iter().find(|span| span.path == path && span.count.is_none());
        if let Some(span) = whole {
            return Some(Cell { offset: span.offset, number: span.number });
        }
        let (path, index) = path.strip_suffix(']')?.rsplit_once('[')?;
        let index: usize = index.parse().ok()?;
        let span =
            self.spans.iter().find(|span| span.path == path && span.count.is_some_and(|n| index < n))?;
        Some(Cell { offset: span.offset + index * span.number.bytes(), number: span.number })
    }

    /// Paths of all numbers in their order, without padding.
    pub fn paths(&self) -> impl Iterator<Item = String> {
        let kept = self.spans.iter().filter(|span| !span.path.contains("_padding"));
        kept.flat_map(|span| {
            (0..span.count.unwrap_or(1)).map(move |index| match span.count {
                Some(_) => format!("{}[{index}]", span.path),
                None => span.path.clone(),
            })
        })
    }

    /// A message's stamp, microseconds; `None` where it has none.
    #[inline]
    #[must_use]
    pub fn stamp_us(&self, message: &[u8]) -> Option<u64> {
        array(message, self.stamp_offset?).map(u64::from_le_bytes)
    }
}

/// Adds the numbers of a definition from `offset` on; the offset after them.
fn spread(
    definition: &Definition,
    all: &HashMap<String, Definition>,
    prefix: &str,
    mut offset: usize,
    deepest: usize,
    spans: &mut Vec<Span>,
) -> Option<usize> {
    let deeper = deepest.checked_sub(1)?;
    for field in &definition.fields {
        let path = format!("{prefix}{}", field.name);
        match &field.kind {
            FieldType::Number(number) => {
                let bytes = number.bytes().checked_mul(field.count.unwrap_or(1))?;
                spans.push(Span { path, number: *number, count: field.count, offset });
                offset = offset.checked_add(bytes)?;
            }
            FieldType::Message(name) => {
                let inner = all.get(name)?;
                for index in 0..field.count.unwrap_or(1) {
                    let prefix = match field.count {
                        Some(_) => format!("{path}[{index}]."),
                        None => format!("{path}."),
                    };
                    let next = spread(inner, all, &prefix, offset, deeper, spans)?;
                    // an empty message has no place in an array
                    if next == offset {
                        return None;
                    }
                    offset = next;
                }
            }
        }
        if offset > MOST_BYTES {
            return None;
        }
    }
    Some(offset)
}
