//! PX4's own logs read message by message, decoded and put together.

use mavid::log::ulog::{Message, UlogReader, UlogReport};
use mavid::log::{self, Input, LogError, OpenOptions};

use super::bytes::Bytes;
use super::tlog::{Trickle, is_sound};

/// Magic and version; a stamp follows.
const BEGINNING: [u8; 8] = *b"ULog\x01\x12\x35\x01";
/// Definitions of topics that are read, and of one that is not.
const DEFINITIONS: [&str; 6] = [
    "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;",
    "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t accelerometer_timestamp_relative;\
     float[3] accelerometer_m_s2;uint32_t accelerometer_integral_dt;",
    "actuator_motors:uint64_t timestamp;float[12] control;uint16_t reversible_flags;uint8_t[6] _padding0;",
    "esc_status:uint64_t timestamp;uint8_t esc_count;uint8_t esc_online_flags;uint8_t[6] _padding0;esc_report[2] esc;",
    "vehicle_status:uint64_t timestamp;uint8_t arming_state;uint8_t nav_state;",
    "unheard_of:uint64_t timestamp;double x;",
];
/// What `esc_status` uses.
const REPORT: &str = "esc_report:int32_t esc_rpm;uint8_t actuator_function;uint8_t[3] _padding0;";
/// Bytes of a message of each of these topics.
const BYTES: [usize; 6] = [32, 44, 58, 32, 10, 16];
/// The seeded bug: a drop-out of this length is not given.
const UNGIVEN_MS: u16 = 0x4d4d;

/// Any bytes behind a beginning, or whole messages.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    match script.u8() % 2 {
        0 => any_bytes(script, seeded),
        _ => whole_messages(script, seeded),
    }
}

#[derive(Debug, PartialEq)]
struct Got {
    /// offset and length of each
    places: Vec<(u64, u64)>,
    data: usize,
    report: UlogReport,
}

fn read(bytes: &[u8], piece: usize, seeded: bool) -> Result<Got, LogError> {
    let mut reader = UlogReader::new(Trickle { left: bytes, piece });
    let (mut places, mut data) = (Vec::new(), 0);
    while let Some(entry) = reader.next_message()? {
        if seeded && entry.message == (Message::Dropout { ms: UNGIVEN_MS }) {
            continue;
        }
        places.push((entry.offset, entry.bytes as u64));
        data += usize::from(matches!(entry.message, Message::Data { .. }));
    }
    Ok(Got { places, data, report: reader.into_report() })
}

/// What holds of whatever comes: messages do not overlap, every byte is a message's or counted, the pieces in which bytes
/// come do not matter, and what is decoded is a recording.
fn any_bytes(mut script: Bytes<'_>, seeded: bool) {
    let piece = usize::from(script.u8()) + 1;
    let bytes = [&BEGINNING[..], &script.array::<8>(), script.rest()].concat();
    let got = read(&bytes, usize::MAX, seeded).expect("bytes in memory that begin as a log");
    account(&bytes, &got);
    assert_eq!(read(&bytes, piece, seeded).ok(), Some(got), "in pieces of {piece} bytes");
    through_the_door(&bytes);
}

fn account(bytes: &[u8], got: &Got) {
    let UlogReport { skipped_bytes, unreadable_bytes, cut_off, .. } = &got.report;
    let mut end = 0;
    for (offset, length) in &got.places {
        assert!(*offset >= end, "messages do not overlap");
        end = offset + length;
    }
    let given: u64 = got.places.iter().map(|(_, length)| length).sum();
    let told = given + skipped_bytes + unreadable_bytes + cut_off.map_or(0, |(bytes, _)| bytes);
    assert_eq!((got.report.bytes, told), (bytes.len() as u64, bytes.len() as u64), "{got:?}");
}

fn through_the_door(bytes: &[u8]) {
    match log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default()) {
        Ok(opened) => is_sound(&opened.recording),
        Err(error) => panic!("a log that is refused: {error}"),
    }
}

fn message(kind: u8, body: &[u8]) -> Vec<u8> {
    let length = u16::try_from(body.len()).unwrap_or(u16::MAX).to_le_bytes();
    [&length[..], &[kind], body].concat()
}

/// Every whole message is given, whatever its stamps and values are.
fn whole_messages(mut script: Bytes<'_>, seeded: bool) {
    let mut bytes = [&BEGINNING[..], &1_000_000_u64.to_le_bytes()].concat();
    let mut sent = 1;
    let mut send = |bytes: &mut Vec<u8>, kind: u8, body: &[u8]| {
        bytes.extend(message(kind, body));
        sent += 1;
    };
    send(&mut bytes, b'F', REPORT.as_bytes());
    for (number, definition) in (0_u8..).zip(DEFINITIONS) {
        send(&mut bytes, b'F', definition.as_bytes());
        let name = definition.split(':').next().unwrap_or_default();
        send(&mut bytes, b'A', &[&[0, number, 0], name.as_bytes()].concat());
    }
    let (mut stamp_us, mut data) = (1_000_000_u64, 0);
    while !script.is_empty() {
        match script.u8() % 8 {
            0 => send(&mut bytes, b'O', &script.array::<2>()),
            1 => send(&mut bytes, b'P', &[b"\x0dint32_t A_BCD", &script.array::<4>()[..]].concat()),
            2 => send(&mut bytes, b'L', &[&b"4"[..], &stamp_us.to_le_bytes(), script.piece()].concat()),
            3 => stamp_us = stamp_us.wrapping_add(u64::from(script.u32())),
            4 => stamp_us = stamp_us.wrapping_sub(u64::from(script.u32())),
            _ => {
                let number = script.u8() % 6;
                stamp_us = stamp_us.wrapping_add(4000);
                let mut body = [&[number, 0][..], &stamp_us.to_le_bytes(), script.piece()].concat();
                body.resize(2 + BYTES[usize::from(number)], 0);
                send(&mut bytes, b'D', &body);
                data += 1;
            }
        }
    }
    let got = read(&bytes, usize::MAX, seeded).expect("whole messages");
    account(&bytes, &got);
    assert_eq!((got.places.len(), got.data), (sent, data), "{:?}", got.report);
    assert!(got.report.losses(0).is_empty());
    through_the_door(&bytes);
}
