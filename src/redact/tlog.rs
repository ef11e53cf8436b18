//! Telemetry logs: stamps of eight bytes, each with a MAVLink frame.

use super::names::{Coordinate, is_secret_parameter, is_suspicious};
use super::pass::{Kind, Pass};
use crate::wire::{Check, CrcSeeds, Frame, MARKER_V2, Payload, STAMP_BYTES, checksum};

/// Messages that hold neither a position on the Earth nor a name of the hardware, by number.
const HARMLESS: &[u32] = &[
    0, 1, 2, 26, 27, 28, 29, 30, 31, 32, 35, 36, 42, 46, 61, 62, 64, 65, 66, 69, 70, 74, 77, 81, 82, 83, 84,
    85, 89, 102, 103, 104, 105, 106, 107, 111, 116, 125, 129, 132, 134, 137, 138, 139, 140, 143, 147, 152,
    163, 165, 168, 173, 193, 225, 226, 230, 231, 241, 244, 245, 290, 291, 331, 375, 436, 11030, 11031, 11032,
];
/// Messages with a latitude and a longitude in 1e-7 degrees, and where these stand.
const POSITIONS: &[(u32, usize)] =
    &[(24, 8), (33, 4), (49, 0), (87, 4), (124, 8), (164, 36), (178, 16), (242, 0)];
const PARAM_VALUE: u32 = 22;
const COMMAND_LONG: u32 = 76;
const AUTOPILOT_VERSION: u32 = 148;
const STATUSTEXT: u32 = 253;
/// The flag that says that a signature is there.
const SIGNED: u8 = 1;

/// Whether a file begins as a telemetry log: a frame behind a stamp, before long.
pub(super) fn is_one(log: &[u8]) -> bool {
    let seeds = CrcSeeds::new();
    (0..log.len().min(4096)).any(|at| whole(log.get(at + STAMP_BYTES..), &seeds).is_some())
}

fn whole<'a>(bytes: Option<&'a [u8]>, seeds: &CrcSeeds) -> Option<Frame<'a>> {
    bytes.and_then(Frame::at_start).filter(|frame| frame.check(seeds) == Check::Right)
}

/// Walks the log; the redacted one comes out. Several frames may share one stamp.
pub(super) fn walk(log: &[u8], pass: &mut Pass) -> Vec<u8> {
    let seeds = CrcSeeds::new();
    let mut out = Vec::with_capacity(log.len());
    let (mut at, mut stamp) = (0, None);
    while at < log.len() {
        let (frame, stamped) = match whole(log.get(at + STAMP_BYTES..), &seeds) {
            Some(frame) => (frame, STAMP_BYTES),
            None => match whole(log.get(at..), &seeds) {
                Some(frame) => (frame, 0),
                None => {
                    at += 1;
                    pass.tally.unread_bytes += 1;
                    continue;
                }
            },
        };
        if stamped > 0 {
            stamp = log.get(at..at + stamped);
        }
        at += stamped + frame.bytes().len();
        match redacted(&frame, pass, &seeds) {
            Some(bytes) => {
                pass.tally.kept += 1;
                out.extend_from_slice(stamp.unwrap_or_default());
                out.extend_from_slice(&bytes);
            }
            None => pass.tally.left_out += 1,
        }
    }
    out
}

/// A frame without what is not to be shared, unsigned; `None` where it is left out.
fn redacted(frame: &Frame<'_>, pass: &mut Pass, seeds: &CrcSeeds) -> Option<Vec<u8>> {
    let id = frame.header().message_id;
    let mut payload = frame.payload().0.to_vec();
    let sent = payload.len();
    match id {
        PARAM_VALUE => {
            if is_secret_parameter(&Payload(&payload).text(8, 16)) {
                pass.empty(payload.get_mut(0..4)?);
            }
        }
        // parameters five and six are a place in many commands
        COMMAND_LONG => pass.empty(grown(&mut payload, 24).get_mut(16..24)?),
        AUTOPILOT_VERSION => {
            pass.empty(grown(&mut payload, 78).get_mut(8..16)?);
            pass.empty(payload.get_mut(60..78)?);
        }
        STATUSTEXT if is_suspicious(&Payload(&payload).text(1, 50)) => return None,
        STATUSTEXT => {}
        _ if HARMLESS.contains(&id) => {}
        _ => {
            let (_, from) = *POSITIONS.iter().find(|(of, _)| *of == id)?;
            grown(&mut payload, from + 8);
            pass.move_in(Coordinate::Latitude, Kind::E7, payload.get_mut(from..from + 4)?);
            pass.move_in(Coordinate::Longitude, Kind::E7, payload.get_mut(from + 4..from + 8)?);
        }
    }
    Some(rebuilt(frame.bytes(), payload, sent, seeds.get(id)?))
}

/// The payload with so many bytes at least: zeros at its end are not sent.
fn grown(payload: &mut Vec<u8>, bytes: usize) -> &mut Vec<u8> {
    if payload.len() < bytes {
        payload.resize(bytes, 0);
    }
    payload
}

fn rebuilt(frame: &[u8], mut payload: Vec<u8>, sent: usize, seed: u8) -> Vec<u8> {
    let is_second = frame.first() == Some(&MARKER_V2);
    let head = if is_second { 10 } else { 6 };
    if is_second {
        while payload.len() > sent.max(1) && payload.last() == Some(&0) {
            payload.pop();
        }
    } else {
        payload.truncate(sent);
    }
    let mut out = frame.get(..head).unwrap_or_default().to_vec();
    if let Some(length) = out.get_mut(1) {
        *length = u8::try_from(payload.len()).unwrap_or(u8::MAX);
    }
    if is_second && let Some(flags) = out.get_mut(2) {
        // the signature no longer holds
        *flags &= !SIGNED;
    }
    out.extend_from_slice(&payload);
    let sum = checksum(out.get(1..).unwrap_or_default(), seed);
    out.extend_from_slice(&sum.to_le_bytes());
    out
}
