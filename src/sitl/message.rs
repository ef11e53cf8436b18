//! A message on its way to the wire: payload in wire order, then the frame around it.

use crate::link::{Signing, TAIL_BYTES};
use crate::units::narrow;
use crate::wire::{CrcSeeds, MARKER_V2, checksum};

/// Payload of one message, little-endian, largest fields first as MAVLink orders them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    pub(super) id: u32,
    payload: Vec<u8>,
    /// seed of a message that the dialect does not know
    seed: Option<u8>,
}

impl Message {
    pub(super) fn new(id: u32) -> Self {
        Self { id, payload: Vec::with_capacity(48), seed: None }
    }

    /// A message that the dialect does not know, with its seed.
    pub(super) fn foreign(id: u32, seed: u8) -> Self {
        Self { seed: Some(seed), ..Self::new(id) }
    }

    fn put<const N: usize>(mut self, bytes: [u8; N]) -> Self {
        self.payload.extend_from_slice(&bytes);
        self
    }

    pub(super) fn u8(self, value: u8) -> Self {
        self.put([value])
    }

    pub(super) fn i8(self, value: i8) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn u16(self, value: u16) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn i16(self, value: i16) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn u32(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn i32(self, value: i32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn u64(self, value: u64) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn i64(self, value: i64) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(super) fn f32(self, value: f64) -> Self {
        self.put(narrow(value).to_le_bytes())
    }

    pub(super) fn f32s(self, values: &[f64]) -> Self {
        values.iter().fold(self, |message, value| message.f32(*value))
    }

    pub(super) fn u16s(self, values: &[u16]) -> Self {
        values.iter().fold(self, |message, value| message.u16(*value))
    }

    /// Text in a field of `bytes`, zero-filled, cut where it is longer.
    pub(super) fn text(mut self, text: &[u8], bytes: usize) -> Self {
        let end = self.payload.len() + bytes;
        self.payload.extend(text.iter().take(bytes));
        self.payload.resize(end, 0);
        self
    }

    /// The MAVLink 2 frame; signed where there is a key, at its time.
    pub(super) fn frame(
        &self,
        seeds: &CrcSeeds,
        (sequence, system, component): (u8, u8, u8),
        signing: Option<(&Signing, u64)>,
    ) -> Vec<u8> {
        let used = self.payload.iter().rposition(|byte| *byte != 0).unwrap_or(0) + 1;
        let payload = &self.payload[..used.min(self.payload.len())];
        let [i0, i1, i2, _] = self.id.to_le_bytes();
        // no message has more than 255 bytes
        let length = u8::try_from(payload.len()).unwrap_or(u8::MAX);
        let flags = u8::from(signing.is_some());
        let mut frame = vec![MARKER_V2, length, flags, 0, sequence, system, component, i0, i1, i2];
        frame.extend_from_slice(payload);
        let seed = self.seed.or_else(|| seeds.get(self.id)).unwrap_or(0);
        let sum = checksum(&frame[1..], seed);
        frame.extend_from_slice(&sum.to_le_bytes());
        if let Some((signing, time)) = signing {
            frame.extend_from_slice(&[0; TAIL_BYTES]);
            signing.sign_at(&mut frame, time);
        }
        frame
    }
}
