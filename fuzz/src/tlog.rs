//! Telemetry logs read record by record, decoded and put together.

use std::io::Read;

use mavid::log::{self, Input, LogError, OpenOptions, TlogReader, TlogReport};
use mavid::recording::{Recording, RecordingBuilder};
use mavid::wire::{Check, ComponentId, Decoder, SystemId, Vehicle};

use super::bytes::Bytes;
use super::frames::{From, SEEDS, VEHICLE, v1, v2};

/// 2023-11-14 UTC.
const START_US: u64 = 1_700_000_000_000_000;
const YEAR_US: u64 = 366 * 86_400 * 1_000_000;
/// HEARTBEAT, SYS_STATUS, SYSTEM_TIME, PARAM_VALUE, ATTITUDE, ATTITUDE_QUATERNION, LOCAL_POSITION_NED,
/// SERVO_OUTPUT_RAW, POSITION_TARGET_LOCAL_NED, HIGHRES_IMU, ESC_STATUS, ODOMETRY, ACTUATOR_OUTPUT_STATUS.
const IDS: [u32; 13] = [0, 1, 2, 22, 30, 31, 32, 36, 85, 105, 291, 331, 375];

/// Any bytes, or whole records with any stamps, the last perhaps torn.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    match script.u8() % 2 {
        0 => any_bytes(script, seeded),
        _ => whole_records(script, seeded),
    }
}

/// Gives a few bytes at a time, as a pipe may.
#[derive(Debug)]
pub struct Trickle<'a> {
    pub left: &'a [u8],
    pub piece: usize,
}

impl Read for Trickle<'_> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        let length = self.piece.min(into.len());
        self.left.read(&mut into[..length])
    }
}

#[derive(Debug, PartialEq)]
struct Got {
    records: Vec<(u64, u64, Vec<u8>)>,
    report: TlogReport,
    failed: Option<String>,
}

fn read(bytes: &[u8], piece: usize, seeded: bool) -> Got {
    let mut reader = TlogReader::new(Trickle { left: bytes, piece });
    let mut records = Vec::new();
    let failed = loop {
        match reader.next_record() {
            Ok(Some(record)) => {
                assert_eq!(record.known, record.frame.check(&SEEDS) == Check::Right);
                // the seeded bug: a stamp of the year 2030 costs its record
                if !(seeded && record.stamp_us / YEAR_US == 60 && record.frame.header().message_id == 105) {
                    records.push((record.stamp_us, record.offset, record.frame.bytes().to_vec()));
                }
            }
            Ok(None) => break None,
            Err(error @ (LogError::Empty | LogError::WrongContent { .. })) => break Some(error.to_string()),
            Err(error) => panic!("an error that bytes in memory cannot have: {error}"),
        }
    };
    Got { records, report: reader.into_report(), failed }
}

/// What holds of whatever comes: each record is where the reader says, every byte is counted, the pieces in which
/// bytes come do not matter, and what is decoded is a recording.
fn any_bytes(mut script: Bytes<'_>, seeded: bool) {
    let piece = usize::from(script.u8()) + 1;
    let bytes = script.rest();
    let got = read(bytes, usize::MAX, seeded);
    let mut end = 0;
    for (_, offset, frame) in &got.records {
        let at = usize::try_from(*offset).expect("an offset in memory");
        assert!(at >= end, "records do not overlap");
        end = at + frame.len();
        assert_eq!(bytes.get(at..end), Some(frame.as_slice()), "a record is given as it stands");
    }
    if got.failed.is_none() {
        account(bytes, &got);
    }
    assert_eq!(read(bytes, piece, seeded), got, "in pieces of {piece} bytes");
    put_together(&got);
    through_the_door(bytes);
}

/// Any bytes are a log, or refused with words.
fn through_the_door(bytes: &[u8]) {
    match log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default()) {
        Ok(opened) => is_sound(&opened.recording),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn account(bytes: &[u8], got: &Got) {
    let report = &got.report;
    let frames: usize = got.records.iter().map(|(_, _, frame)| frame.len()).sum();
    let stamps = 8 * (report.frames - report.shared_stamps);
    let told = frames as u64 + stamps + report.skipped_bytes + report.truncated_tail_bytes;
    assert_eq!(report.bytes, bytes.len() as u64);
    assert_eq!(report.frames, got.records.len() as u64);
    assert!(told <= report.bytes, "{told} bytes told of {}", report.bytes);
    // records with a wrong checksum are counted without their length, 16 to 291 bytes each
    let dropped = report.bytes - told;
    assert!(
        (16 * report.bad_crc..=291 * report.bad_crc).contains(&dropped),
        "{dropped} bytes untold: {report:?}"
    );
}

fn put_together(got: &Got) {
    let Some((stamp_us, ..)) = got.records.first() else { return };
    let component = ComponentId(VEHICLE.1);
    let vehicle =
        Vehicle { system: SystemId(VEHICLE.0.into()), component, autopilot: Default::default(), kind: None };
    let mut decoder = Decoder::new(vehicle, None, *stamp_us);
    let mut builder = RecordingBuilder::new();
    let log = as_log(got);
    let mut reader = TlogReader::new(log.as_slice());
    while let Ok(Some(record)) = reader.next_record() {
        decoder.decode(&record, &mut |event| builder.add(event));
    }
    decoder.finish(&mut |event| builder.add(event));
    is_sound(&builder.finish().0);
}

/// Streams are in order of time, of one width, and have no time that is no number.
pub fn is_sound(recording: &Recording) {
    for (key, stream) in &recording.streams {
        assert_eq!(stream.values.len(), stream.width * stream.time_s.len(), "{key:?}");
        assert!(stream.time_s.iter().all(|time_s| time_s.is_finite()), "{key:?}");
        assert!(stream.time_s.windows(2).all(|pair| pair[0] < pair[1]), "{key:?}: {:?}", stream.time_s);
    }
}

/// A whole frame, by the script; every other may be read by its length alone.
fn scripted(script: &mut Bytes<'_>, sequence: u8) -> Vec<u8> {
    let id = script.one_of(&IDS);
    let from = From { sender: VEHICLE, sequence };
    let payload = script.piece();
    match u8::try_from(id) {
        Ok(id) if script.u8().is_multiple_of(4) => v1(id, from, payload),
        _ => v2(id, from, payload),
    }
}

/// Every whole frame is given: behind stamps that repeat, go back, are years off, and before a torn end.
fn whole_records(mut script: Bytes<'_>, seeded: bool) {
    let torn = usize::from(script.u8());
    let mut stamp_us = START_US;
    let (mut sent, mut bytes) = (Vec::new(), Vec::new());
    while !script.is_empty() {
        let off_us = match script.u8() % 8 {
            0 => 0,
            1 => 10_000,
            2 => 250,
            3 => 10 * YEAR_US,
            4 => u64::from(script.u16()) * 1000,
            5 => 7 * YEAR_US,
            _ => 4000,
        };
        stamp_us = if script.u8().is_multiple_of(16) {
            stamp_us.saturating_sub(off_us).max(START_US - 10 * YEAR_US)
        } else {
            (stamp_us + off_us).min(START_US + 60 * YEAR_US)
        };
        let frame = scripted(&mut script, u8::try_from(sent.len() % 256).unwrap_or(0));
        bytes.extend(stamp_us.to_be_bytes());
        bytes.extend(&frame);
        sent.push(frame);
    }
    let last = sent.last().map_or(0, Vec::len);
    // at least a byte of the frame stays, and at least one is torn off where any is
    let cut = if sent.len() > 1 && last > 1 { torn % last } else { 0 };
    bytes.truncate(bytes.len() - cut);
    sent.truncate(sent.len() - usize::from(cut > 0));
    let got = read(&bytes, usize::MAX, seeded);
    // behind a torn head a whole record may stand in what is left of its payload
    let whole = if cut > 0 { sent.len().min(got.records.len()) } else { got.records.len() };
    let given: Vec<&Vec<u8>> = got.records[..whole].iter().map(|(_, _, frame)| frame).collect();
    assert!(given.iter().copied().eq(&sent), "sent {sent:02x?}, given {given:02x?}, {:?}", got.report);
    put_together(&got);
}

fn as_log(got: &Got) -> Vec<u8> {
    let records = got.records.iter();
    records.flat_map(|(stamp_us, _, frame)| [&stamp_us.to_be_bytes()[..], frame].concat()).collect()
}
