//! MAVLink frames with right checksums.

use std::sync::LazyLock;

use mavid::wire::{CrcSeeds, Frame, MARKER_V1, MARKER_V2, checksum};

/// The dialect's checksum seeds, made once.
pub static SEEDS: LazyLock<CrcSeeds> = LazyLock::new(CrcSeeds::new);

/// A message id that no dialect has.
pub const UNKNOWN_ID: u32 = 60_001;
/// Of the autopilot.
pub const VEHICLE: (u8, u8) = (1, 1);
const SIGNED: u8 = 1;
const SIGNATURE_BYTES: usize = 13;

/// Who sends, with which sequence number.
#[derive(Debug, Clone, Copy)]
pub struct From {
    pub sender: (u8, u8),
    pub sequence: u8,
}

/// A MAVLink 2 frame; of an unknown message with a checksum of seed 0.
pub fn v2(id: u32, from: From, payload: &[u8]) -> Vec<u8> {
    body(id, (0, from), payload)
}

/// The same with room for a signature, all zeros.
pub fn signed(id: u32, from: From, payload: &[u8]) -> Vec<u8> {
    let mut frame = body(id, (SIGNED, from), payload);
    frame.extend([0; SIGNATURE_BYTES]);
    frame
}

fn body(id: u32, (flags, from): (u8, From), payload: &[u8]) -> Vec<u8> {
    let [i0, i1, i2, _] = id.to_le_bytes();
    let payload = &payload[..payload.len().min(255)];
    let (system, component) = from.sender;
    let mut frame = vec![MARKER_V2, length(payload), flags, 0, from.sequence, system, component, i0, i1, i2];
    frame.extend_from_slice(payload);
    close(&mut frame, id);
    frame
}

/// A MAVLink 1 frame of a message id below 256.
pub fn v1(id: u8, from: From, payload: &[u8]) -> Vec<u8> {
    let payload = &payload[..payload.len().min(255)];
    let (system, component) = from.sender;
    let mut frame = vec![MARKER_V1, length(payload), from.sequence, system, component, id];
    frame.extend_from_slice(payload);
    close(&mut frame, id.into());
    frame
}

fn length(payload: &[u8]) -> u8 {
    u8::try_from(payload.len()).unwrap_or(u8::MAX)
}

fn close(frame: &mut Vec<u8>, id: u32) {
    let sum = checksum(&frame[1..], SEEDS.get(id).unwrap_or(0));
    frame.extend(sum.to_le_bytes());
}

/// The whole frame at the start of bytes that were made as one.
pub fn frame(bytes: &[u8]) -> Frame<'_> {
    Frame::at_start(bytes).expect("bytes made as a frame")
}

/// A payload of this length written field by field, zero elsewhere.
pub fn payload(bytes: usize, fields: &[(usize, &[u8])]) -> Vec<u8> {
    let mut payload = vec![0; bytes];
    for (offset, field) in fields {
        payload[*offset..offset + field.len()].copy_from_slice(field);
    }
    payload
}
