//! Messages of a ULog: a length, a letter, and what the letter says.

use super::schema::{NumberType, Schema, Subscription, is_name};
use crate::autopilot::{ULOG_FLAG_BYTES, ULOG_HEAD_BYTES, ULOG_MAGIC};

/// Length and letter before each message.
pub(super) const PREFIX_BYTES: usize = 3;
/// A message with its prefix is no longer.
pub(super) const MOST_BYTES: usize = PREFIX_BYTES + u16::MAX as usize;
/// What a synchronisation message holds.
const SYNC: [u8; 8] = [0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12];

/// One message of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Message<'a> {
    /// the beginning of a log
    Begin {
        /// microseconds of the vehicle's clock
        start_us: u64,
    },
    /// something about the log or the vehicle
    Info {
        /// type, such as `char[3]`
        kind: &'a str,
        /// name, such as `sys_name`
        key: &'a str,
        /// bytes of that type
        value: &'a [u8],
    },
    /// a parameter's value, at the beginning or when it changed
    Parameter {
        /// name
        name: &'a str,
        /// value
        value: f64,
    },
    /// a parameter's default in the vehicle's configuration
    ParameterDefault {
        /// name
        name: &'a str,
        /// value
        value: f64,
    },
    /// messages of a topic follow
    Subscribe(&'a Subscription),
    /// one message of a topic
    Data {
        /// whose
        subscription: &'a Subscription,
        /// fields, as the subscription's layout says
        bytes: &'a [u8],
    },
    /// what the vehicle said
    Text {
        /// 0 emergency, 3 error, 4 warning, 6 information, 7 debugging
        severity: u8,
        /// microseconds of the vehicle's clock
        stamp_us: u64,
        /// UTF-8, as far as it is
        text: &'a [u8],
    },
    /// the vehicle could not write for so long
    Dropout {
        /// milliseconds
        ms: u16,
    },
    /// flags, definitions, synchronisation, and kinds that are not known
    Other {
        /// its letter
        kind: u8,
    },
}

/// How much bytes look like a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Likeness {
    /// not at all
    None,
    /// it may be one of a kind or number that is not known
    Weak,
    /// its contents fit its kind
    Strong,
}

/// The bytes at the beginning of `sight` as a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shape {
    pub(super) likeness: Likeness,
    /// all of it, prefix included
    pub(super) bytes: usize,
}

/// What stands at the beginning of `sight`; `None` where it is too short to say.
#[inline]
pub(super) fn shape(sight: &[u8], schema: &Schema) -> Option<Shape> {
    let prefix = sight.first_chunk::<PREFIX_BYTES>()?;
    if prefix[..] == ULOG_MAGIC[..PREFIX_BYTES] && sight.starts_with(&ULOG_MAGIC) {
        return Some(Shape { likeness: Likeness::Strong, bytes: ULOG_HEAD_BYTES });
    }
    let [low, high, kind] = *prefix;
    let length = usize::from(u16::from_le_bytes([low, high]));
    let bytes = PREFIX_BYTES + length;
    let body = &sight[PREFIX_BYTES..bytes.min(sight.len())];
    Some(Shape { likeness: likeness(kind, length, body, schema), bytes })
}

/// Judges a message by its kind, its length and as much of its body as there is.
#[inline]
fn likeness(kind: u8, length: usize, body: &[u8], schema: &Schema) -> Likeness {
    let strong_if = |is: bool| if is { Likeness::Strong } else { Likeness::None };
    let cut = body.len() < length;
    match kind {
        b'D' => match number(body) {
            Some(id) => match schema.fits(id, length.saturating_sub(2)) {
                Some(fits) => strong_if(fits),
                None => Likeness::Weak,
            },
            None => {
                if length >= 2 && cut {
                    Likeness::Weak
                } else {
                    Likeness::None
                }
            }
        },
        b'S' => strong_if(length >= SYNC.len() && (cut || body.starts_with(&SYNC))),
        b'O' | b'R' => strong_if(length == 2),
        b'B' => strong_if(length == ULOG_FLAG_BYTES),
        b'L' => strong_if(length >= 9 && body.first().is_none_or(|level| severity(*level).is_some())),
        b'C' => strong_if(length >= 11 && body.first().is_none_or(|level| severity(*level).is_some())),
        b'F' => strong_if(length >= 3 && begins_with_name(body)),
        b'A' => strong_if(length > 3 && body.get(3..).is_none_or(|name| cut || is_text_name(name))),
        b'I' | b'P' => strong_if(has_key(body, 0, length)),
        b'M' | b'Q' => strong_if(has_key(body, 1, length)),
        _ if kind.is_ascii_uppercase() => Likeness::Weak,
        _ => Likeness::None,
    }
}

/// Length, prefix included, of the data message at the beginning of `sight`, where its topic is known and has messages of this
/// length. It is what [`shape`] calls strong, told with less.
#[inline]
pub(super) fn data_bytes(sight: &[u8], schema: &Schema) -> Option<usize> {
    let [low, high, b'D', id @ ..] = *sight.first_chunk::<{ PREFIX_BYTES + 2 }>()? else { return None };
    let length = usize::from(u16::from_le_bytes([low, high]));
    let fits = length >= 2 && schema.fits(u16::from_le_bytes(id), length - 2) == Some(true);
    fits.then_some(PREFIX_BYTES + length)
}

fn number(body: &[u8]) -> Option<u16> {
    body.first_chunk().copied().map(u16::from_le_bytes)
}

/// A name and a colon, as far as they are there.
fn begins_with_name(body: &[u8]) -> bool {
    let name = body.split(|byte| *byte == b':').next().unwrap_or_default();
    name.is_empty() && body.is_empty() || is_text_name(name)
}

fn is_text_name(name: &[u8]) -> bool {
    str::from_utf8(name).is_ok_and(is_name)
}

/// A length and so many letters stand behind `before` bytes, as far as they are there.
fn has_key(body: &[u8], before: usize, length: usize) -> bool {
    let Some(bytes) = body.get(before).copied().map(usize::from) else { return body.len() < length };
    let key = body.get(before + 1..).unwrap_or_default();
    let key = &key[..bytes.min(key.len())];
    before + 1 + bytes <= length && bytes > 2 && key.iter().all(|byte| (b' '..=b'~').contains(byte))
}

/// MAV_SEVERITY of a level, which is written as a digit.
fn severity(level: u8) -> Option<u8> {
    match level {
        b'0'..=b'7' => Some(level - b'0'),
        0..=7 => Some(level),
        _ => None,
    }
}

/// A message by its letter and its body; `None` where the body is not what the letter says.
pub(super) fn parse<'a>(kind: u8, body: &'a [u8], schema: &'a Schema) -> Option<Message<'a>> {
    Some(match kind {
        b'D' => Message::Data { subscription: schema.subscription(number(body)?)?, bytes: body.get(2..)? },
        b'I' => {
            let (kind, key, value) = keyed(body)?;
            Message::Info { kind, key, value }
        }
        b'P' => {
            let (name, value) = parameter(body)?;
            Message::Parameter { name, value }
        }
        b'Q' => {
            let (kinds, rest) = body.split_first()?;
            let (name, value) = parameter(rest)?;
            match kinds & OF_SETUP {
                0 => Message::Other { kind: b'Q' },
                _ => Message::ParameterDefault { name, value },
            }
        }
        b'L' => text(body, 0)?,
        b'C' => text(body, 2)?,
        b'O' => Message::Dropout { ms: number(body)? },
        kind => Message::Other { kind },
    })
}

/// Type, name and bytes of a value.
fn keyed(body: &[u8]) -> Option<(&str, &str, &[u8])> {
    let (bytes, rest) = body.split_first()?;
    let (key, value) = rest.split_at_checked(usize::from(*bytes))?;
    let (kind, name) = str::from_utf8(key).ok()?.split_once(' ')?;
    Some((kind, name, value))
}

/// Of the kinds of a default that of the vehicle's configuration; the release's own may be another.
const OF_SETUP: u8 = 2;

fn parameter(body: &[u8]) -> Option<(&str, f64)> {
    let (kind, name, value) = keyed(body)?;
    let number = NumberType::of(kind)?;
    (number.bytes() == value.len() && is_name(name)).then(|| (name, number.read(value, 0)))
}

/// A text whose stamp stands behind its level and `tag_bytes` more.
fn text(body: &[u8], tag_bytes: usize) -> Option<Message<'_>> {
    let (level, rest) = body.split_first()?;
    let (stamp, text) = rest.get(tag_bytes..)?.split_first_chunk()?;
    Some(Message::Text { severity: severity(*level)?, stamp_us: u64::from_le_bytes(*stamp), text })
}

/// Number, instance and name of what is subscribed to.
pub(super) fn subscription(body: &[u8]) -> Option<(u16, u8, &str)> {
    let ([instance, low, high], name) = body.split_first_chunk::<3>()?;
    let name = str::from_utf8(name).ok().filter(|name| is_name(name))?;
    Some((u16::from_le_bytes([*low, *high]), *instance, name))
}

/// Offsets at which data were appended after the file had been closed, where the flags say that there are some.
pub(super) fn appended_offsets(body: &[u8]) -> impl Iterator<Item = u64> {
    const IS_APPENDED: u8 = 1;
    let flagged = body.get(8).is_some_and(|flags| flags & IS_APPENDED != 0);
    let offsets = body.get(16..ULOG_FLAG_BYTES).unwrap_or_default();
    let offsets = offsets.chunks_exact(8).filter_map(|bytes| bytes.first_chunk().copied());
    offsets.map(u64::from_le_bytes).filter(move |offset| flagged && *offset > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(bytes: &[u8]) -> Option<Likeness> {
        shape(bytes, &Schema::default()).map(|shape| shape.likeness)
    }

    #[test]
    fn noise_and_zeros_look_like_no_message() {
        assert_eq!(judged(&[0; 40]), Some(Likeness::None));
        assert_eq!(judged(b"\x05\x00P\x30xx"), Some(Likeness::None));
        assert_eq!(judged(b"\x02\x00L7x"), Some(Likeness::None));
        assert_eq!(judged(b"\x08"), None);
    }

    #[test]
    fn messages_are_told_by_their_contents() {
        assert_eq!(judged(b"\x09\x00I\x06char a1\x00"), Some(Likeness::Strong));
        assert_eq!(judged(b"\x06\x00D\x01\x00\x01\x02\x03\x04"), Some(Likeness::Weak));
        assert_eq!(judged(b"ULog\x01\x12\x35\x01\0\0\0\0\0\0\0\0"), Some(Likeness::Strong));
        assert_eq!(judged(b"\x02\x00Zxx"), Some(Likeness::Weak));
    }

    #[test]
    fn what_a_body_holds_is_read() {
        let schema = Schema::default();
        let parameter = b"\x0dint32_t A_BCD\x05\x00\x00\x00";
        assert_eq!(parse(b'P', parameter, &schema), Some(Message::Parameter { name: "A_BCD", value: 5.0 }));
        let default = |kinds: u8| [&[kinds][..], parameter].concat();
        let told = Message::ParameterDefault { name: "A_BCD", value: 5.0 };
        assert_eq!(parse(b'Q', &default(3), &schema), Some(told));
        assert_eq!(parse(b'Q', &default(1), &schema), Some(Message::Other { kind: b'Q' }));
        let text = b"4\x10\x00\x00\x00\x00\x00\x00\x00low";
        let expected = Message::Text { severity: 4, stamp_us: 16, text: b"low" };
        assert_eq!(parse(b'L', text, &schema), Some(expected));
        assert_eq!(parse(b'L', &text[..5], &schema), None);
        assert_eq!(subscription(b"\x01\x02\x00name"), Some((2, 1, "name")));
    }

    #[test]
    fn appended_parts_count_only_where_they_are_flagged() {
        let mut flags = [0_u8; ULOG_FLAG_BYTES];
        flags[16] = 77;
        assert_eq!(appended_offsets(&flags).count(), 0);
        flags[8] = 1;
        assert_eq!(appended_offsets(&flags).collect::<Vec<_>>(), [77]);
    }
}
