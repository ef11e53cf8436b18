//! Damage done to a recording, by a script of few bytes.

use super::bytes::Bytes;
use super::frames::{From, frame, v2};

/// Single-precision numbers on which reading rests: message id, offset of the first, how many.
const NUMBERS: [(u32, usize, u8); 9] = [
    (31, 4, 7),
    (32, 4, 6),
    (105, 8, 13),
    (331, 8, 13),
    (30, 4, 6),
    (85, 4, 11),
    (375, 12, 8),
    (291, 12, 8),
    (230, 8, 8),
];
/// Stamps of the vehicle's clock: message id, bytes; milliseconds in four, microseconds in eight, at the start.
const CLOCKS: [(u32, usize); 10] =
    [(31, 4), (32, 4), (85, 4), (30, 4), (36, 4), (105, 8), (375, 8), (291, 8), (331, 8), (230, 8)];
const ODD: [f32; 8] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.4e38, 1e-45, 0.0, -1.0, 1e10];
const MAGNITUDES_US: [u64; 6] = [1, 100_000, 3_000_000, 3_600_000_000, 86_400_000_000, 1 << 50];

/// One record of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub stamp_us: u64,
    pub bytes: Vec<u8>,
}

/// The log as its script damages it; at most so many things happen to it.
pub fn damaged(whole: &[Record], script: &mut Bytes<'_>, most: usize) -> Vec<u8> {
    let mut records = whole.to_vec();
    let mut bytes_too = Vec::new();
    for _ in 0..most {
        if script.is_empty() || records.is_empty() {
            break;
        }
        let (what, from, length) = (script.u8(), script.u16(), script.u8());
        let from = usize::from(from) * records.len() / 65_536;
        // 1 to 65 025 records
        let length = (1 + usize::from(length) * usize::from(length)).min(records.len() - from);
        let to = from + length;
        match what % 12 {
            0 => drop(records.drain(from..to)),
            1 => {
                let again = records[from..to].to_vec();
                records.splice(from..from, again);
            }
            2 => records[from..to].reverse(),
            3 => records.rotate_left(from),
            4 => numbers(&mut records[from..to], script),
            5 => clocks(&mut records[from..to], script),
            6 => stamps(&mut records[from..to], script),
            7 => senders(&mut records[from..to], script),
            8 => bodies(&mut records[from..to], script),
            9 => still(&mut records[from..to], script),
            10 => records.truncate(to.max(1)),
            _ => bytes_too.push((what, script.u32(), script.u8())),
        }
    }
    let mut log = joined(&records);
    for (_, at, how) in bytes_too {
        break_bytes(&mut log, at, how);
    }
    log
}

/// Records as a telemetry log.
pub fn joined(records: &[Record]) -> Vec<u8> {
    records.iter().flat_map(|record| [&record.stamp_us.to_be_bytes()[..], &record.bytes].concat()).collect()
}

/// The same frame with another payload.
fn change(record: &mut Record, change: impl FnOnce(&mut Vec<u8>)) {
    let old = frame(&record.bytes);
    let header = *old.header();
    let mut payload = old.payload().0.to_vec();
    change(&mut payload);
    let system = u8::try_from(header.system.0).unwrap_or(1);
    let from = From { sender: (system, header.component.0), sequence: header.sequence };
    record.bytes = v2(header.message_id, from, &payload);
}

fn write(payload: &mut Vec<u8>, at: usize, field: &[u8]) {
    if payload.len() < at + field.len() {
        payload.resize(at + field.len(), 0);
    }
    payload[at..at + field.len()].copy_from_slice(field);
}

fn id_of(record: &Record) -> u32 {
    frame(&record.bytes).header().message_id
}

/// Odd numbers, in one field of one message or in many.
fn numbers(records: &mut [Record], script: &mut Bytes<'_>) {
    let (id, first, count) = script.one_of(&NUMBERS);
    let at = first + 4 * usize::from(script.u8() % count);
    let value = script.one_of(&ODD).to_le_bytes();
    let each = usize::from(script.u8() % 8) + 1;
    for record in records.iter_mut().filter(|record| id_of(record) == id).step_by(each) {
        change(record, |payload| write(payload, at, &value));
    }
}

/// The vehicle's clock jumps, runs at another pace, or repeats.
fn clocks(records: &mut [Record], script: &mut Bytes<'_>) {
    let (how, by_us) = (script.u8(), script.one_of(&MAGNITUDES_US));
    for record in records {
        let Some((_, width)) = CLOCKS.iter().find(|(id, _)| *id == id_of(record)) else { continue };
        let unit_us = if *width == 4 { 1000 } else { 1 };
        change(record, |payload| {
            let mut field = [0; 8];
            field[..payload.len().min(*width)].copy_from_slice(&payload[..payload.len().min(*width)]);
            let time = u64::from_le_bytes(field);
            let time = match how % 4 {
                0 => time.wrapping_add(by_us / unit_us),
                1 => time.wrapping_sub(by_us / unit_us),
                2 => time.wrapping_mul(2),
                _ => by_us / unit_us,
            };
            write(payload, 0, &time.to_le_bytes()[..*width]);
        });
    }
}

/// The host's clock jumps, or repeats.
fn stamps(records: &mut [Record], script: &mut Bytes<'_>) {
    let (how, by_us) = (script.u8(), script.one_of(&MAGNITUDES_US));
    for record in records {
        record.stamp_us = match how % 4 {
            0 => record.stamp_us.wrapping_add(by_us),
            1 => record.stamp_us.wrapping_sub(by_us),
            2 => by_us,
            _ => record.stamp_us,
        };
    }
}

/// Others speak.
fn senders(records: &mut [Record], script: &mut Bytes<'_>) {
    let (system, component) = (script.u8(), script.u8());
    for record in records {
        let old = frame(&record.bytes);
        let (id, sequence) = (old.header().message_id, old.header().sequence);
        record.bytes = v2(id, From { sender: (system, component), sequence }, old.payload().0);
    }
}

/// Payloads of any bytes.
fn bodies(records: &mut [Record], script: &mut Bytes<'_>) {
    let piece = script.piece();
    let each = usize::from(script.u8()) + 1;
    for record in records.iter_mut().step_by(each) {
        change(record, |payload| piece.clone_into(payload));
    }
}

/// A message says the same again and again.
fn still(records: &mut [Record], script: &mut Bytes<'_>) {
    let (id, ..) = script.one_of(&NUMBERS);
    let mut first: Option<Vec<u8>> = None;
    for record in records.iter_mut().filter(|record| id_of(record) == id) {
        let first = first.get_or_insert_with(|| frame(&record.bytes).payload().0.to_vec()).clone();
        change(record, |payload| {
            for (index, byte) in first.iter().enumerate().skip(8) {
                write(payload, index, &[*byte]);
            }
        });
    }
}

/// Flipped, cut off, inserted, zeroed.
fn break_bytes(log: &mut Vec<u8>, at: u32, how: u8) {
    if log.is_empty() {
        return;
    }
    let at = usize::try_from(at).unwrap_or(0) % log.len();
    let length = (1 + usize::from(how)).min(log.len() - at);
    match how % 4 {
        0 => log[at] ^= how,
        1 => log.truncate(at),
        2 => drop(log.splice(at..at, std::iter::repeat_n(how, length * 16))),
        _ => log[at..at + length].fill(0),
    }
}
