//! One MAVLink frame as bytes, and what its header says.

use std::fmt;

use super::checksum::{CrcSeeds, checksum};
use crate::text;

/// Marker of a MAVLink 1 frame.
pub const MARKER_V1: u8 = 0xFE;
/// Marker of a MAVLink 2 frame.
pub const MARKER_V2: u8 = 0xFD;
/// No frame is longer: 13 bytes of header, 255 of payload, 2 of checksum, 13 of signature.
pub const MAX_FRAME_BYTES: usize = 283;

const CHECKSUM_BYTES: usize = 2;
const SIGNATURE_BYTES: usize = 13;
const SIGNED: u8 = 0x01;
const WIDE_SYSTEM_ID: u8 = 0x02;

/// MAVLink system id: one vehicle or ground station. One byte, four with MAVLink 2.1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SystemId(pub u32);

/// MAVLink component id: one part of a system, 1 for the autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentId(pub u8);

impl fmt::Display for SystemId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

impl fmt::Display for ComponentId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

/// Framing of one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// MAVLink 1
    V1,
    /// MAVLink 2
    V2,
}

/// What a frame's header says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// framing
    pub version: Version,
    /// incompatibility flags, 0 for MAVLink 1
    pub incompat_flags: u8,
    /// counts up by one with each frame of a sender
    pub sequence: u8,
    /// who sent it
    pub system: SystemId,
    /// which part of it
    pub component: ComponentId,
    /// which message
    pub message_id: u32,
    payload_start: usize,
    payload_bytes: usize,
}

/// What may stand at the start of some bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// no frame begins here
    NotAFrame,
    /// a frame may begin here; there are too few bytes to read its header
    TooShort,
    /// a frame of this shape may begin here
    Header(Header),
}

impl Header {
    /// Reads the header at the start of `bytes`. Incompatibility flags that MAVLink does not define make
    /// the layout unknown: no frame.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Start {
        match bytes.first() {
            None => Start::TooShort,
            Some(&MARKER_V1) => Self::read_v1(bytes),
            Some(&MARKER_V2) => Self::read_v2(bytes),
            Some(_) => Start::NotAFrame,
        }
    }

    fn read_v1(bytes: &[u8]) -> Start {
        let Some(&[_, length, sequence, system, component, id]) = bytes.first_chunk::<6>() else {
            return Start::TooShort;
        };
        Start::Header(Self {
            version: Version::V1,
            incompat_flags: 0,
            sequence,
            system: SystemId(system.into()),
            component: ComponentId(component),
            message_id: id.into(),
            payload_start: 6,
            payload_bytes: length.into(),
        })
    }

    fn read_v2(bytes: &[u8]) -> Start {
        if bytes.get(2).is_some_and(|flags| flags & !(SIGNED | WIDE_SYSTEM_ID) != 0) {
            return Start::NotAFrame;
        }
        let Some(&[_, length, incompat_flags, _, sequence, s0, s1, s2, s3, s4]) = bytes.first_chunk::<10>()
        else {
            return Start::TooShort;
        };
        let narrow = Self {
            version: Version::V2,
            incompat_flags,
            sequence,
            system: SystemId(s0.into()),
            component: ComponentId(s1),
            message_id: u32::from_le_bytes([s2, s3, s4, 0]),
            payload_start: 10,
            payload_bytes: length.into(),
        };
        if incompat_flags & WIDE_SYSTEM_ID == 0 {
            return Start::Header(narrow);
        }
        let Some(&[.., i0, i1, i2]) = bytes.first_chunk::<13>() else {
            return Start::TooShort;
        };
        Start::Header(Self {
            system: SystemId(u32::from_le_bytes([s0, s1, s2, s3])),
            component: ComponentId(s4),
            message_id: u32::from_le_bytes([i0, i1, i2, 0]),
            payload_start: 13,
            ..narrow
        })
    }

    /// Bytes of the whole frame, from its marker to the end of its checksum or signature.
    #[must_use]
    pub fn frame_bytes(&self) -> usize {
        let signature = if self.is_signed() { SIGNATURE_BYTES } else { 0 };
        self.payload_start + self.payload_bytes + CHECKSUM_BYTES + signature
    }

    /// A signature follows the checksum.
    #[must_use]
    pub fn is_signed(&self) -> bool {
        self.incompat_flags & SIGNED != 0
    }
}

/// What a frame's checksum says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Check {
    /// the message is known and its checksum is right
    Right,
    /// the message is known and its checksum is wrong
    Wrong,
    /// the message is not known, so its checksum cannot be told
    UnknownMessage,
}

/// A frame, byte for byte as it was received.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    header: Header,
    bytes: &'a [u8],
}

impl<'a> Frame<'a> {
    /// The frame at the start of `bytes`; `None` where the header is not of one or bytes are missing.
    #[must_use]
    pub fn at_start(bytes: &'a [u8]) -> Option<Self> {
        let Start::Header(header) = Header::read(bytes) else { return None };
        Some(Self { header, bytes: bytes.get(..header.frame_bytes())? })
    }

    /// What its header says.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The whole frame, from its marker to the end of its checksum or signature.
    #[must_use]
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Its payload as sent: MAVLink 2 leaves out trailing zeros.
    #[must_use]
    pub fn payload(&self) -> Payload<'a> {
        let start = self.header.payload_start;
        Payload(&self.bytes[start..start + self.header.payload_bytes])
    }

    /// Its checksum as sent.
    #[must_use]
    pub fn sent_checksum(&self) -> u16 {
        let at = self.header.payload_start + self.header.payload_bytes;
        u16::from_le_bytes([self.bytes[at], self.bytes[at + 1]])
    }

    /// Whether the checksum is right.
    #[must_use]
    pub fn check(&self, seeds: &CrcSeeds) -> Check {
        let Some(seed) = seeds.get(self.header.message_id) else { return Check::UnknownMessage };
        let end = self.header.payload_start + self.header.payload_bytes;
        if checksum(&self.bytes[1..end], seed) == self.sent_checksum() { Check::Right } else { Check::Wrong }
    }
}

/// A frame's payload, read by byte offset, little-endian. Bytes beyond its end are zero: MAVLink 2 cuts
/// trailing zeros, and an older sender does not know the newer fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Payload<'a>(pub &'a [u8]);

impl<'a> Payload<'a> {
    #[inline]
    fn field<const N: usize>(self, offset: usize) -> [u8; N] {
        if let Some(field) = self.0.get(offset..).and_then(<[u8]>::first_chunk::<N>) {
            return *field;
        }
        let mut field = [0; N];
        for (to, from) in field.iter_mut().zip(self.0.iter().skip(offset)) {
            *to = *from;
        }
        field
    }

    /// Unsigned byte.
    #[must_use]
    pub fn u8(self, offset: usize) -> u8 {
        self.0.get(offset).copied().unwrap_or(0)
    }

    /// Signed byte pair.
    #[must_use]
    pub fn i16(self, offset: usize) -> i16 {
        i16::from_le_bytes(self.field(offset))
    }

    /// Unsigned byte pair.
    #[must_use]
    pub fn u16(self, offset: usize) -> u16 {
        u16::from_le_bytes(self.field(offset))
    }

    /// Signed, four bytes.
    #[must_use]
    pub fn i32(self, offset: usize) -> i32 {
        i32::from_le_bytes(self.field(offset))
    }

    /// Unsigned, four bytes.
    #[must_use]
    pub fn u32(self, offset: usize) -> u32 {
        u32::from_le_bytes(self.field(offset))
    }

    /// Unsigned, eight bytes.
    #[must_use]
    pub fn u64(self, offset: usize) -> u64 {
        u64::from_le_bytes(self.field(offset))
    }

    /// Single precision, widened.
    #[must_use]
    pub fn f32(self, offset: usize) -> f64 {
        f32::from_le_bytes(self.field(offset)).into()
    }

    /// `N` consecutive single-precision values, widened.
    #[must_use]
    pub fn f32s<const N: usize>(self, offset: usize) -> [f64; N] {
        std::array::from_fn(|index| self.f32(offset + 4 * index))
    }

    /// Text up to the first zero byte, at most `bytes` long; other than UTF-8 is replaced, and what would command a
    /// terminal or break a line is escaped.
    #[must_use]
    pub fn text(self, offset: usize, bytes: usize) -> String {
        text::clean(&String::from_utf8_lossy(self.text_bytes(offset, bytes)))
    }

    /// As [`Self::text`], as it came: for a text in several messages.
    pub(super) fn text_bytes(self, offset: usize, bytes: usize) -> &'a [u8] {
        let field = self.0.get(offset..).unwrap_or_default();
        let field = &field[..bytes.min(field.len())];
        let end = field.iter().position(|&byte| byte == 0).unwrap_or(field.len());
        &field[..end]
    }
}
