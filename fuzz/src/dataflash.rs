//! Logs of ArduPilot, binary and text, message by message and put together.

use mavid::log::{self, DataflashDamage, DataflashReader, DataflashTextReader, Input, Letter, OpenOptions};

use super::bytes::Bytes;
use super::tlog::{Trickle, is_sound};

/// Definitions that a log may begin with: number, name, format, fields.
const DEFINED: [(u8, &str, &str, &str); 12] = [
    (129, "PARM", "QNf", "TimeUS,Name,Value"),
    (130, "MSG", "QZ", "TimeUS,Message"),
    (131, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
    (132, "ATT", "Qcccccc", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw"),
    (133, "ESC", "QBf", "TimeUS,Instance,RPM"),
    (134, "RCOU", "QHHHH", "TimeUS,C1,C2,C3,C4"),
    (135, "EV", "QB", "TimeUS,Id"),
    (136, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn"),
    (137, "ISBH", "QHBBHHQf", "TimeUS,N,type,instance,mul,smp_cnt,SampleUS,smp_rate"),
    (138, "ISBD", "QHHaaa", "TimeUS,N,seqno,x,y,z"),
    (139, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds"),
    (140, "XKF4", "QBff", "TimeUS,C,OFN,OFE"),
];

/// Any bytes, perhaps behind definitions; any text behind lines that define; whole messages.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    match script.u8() % 4 {
        0 => any_bytes(&mut script, &[], seeded),
        1 => any_bytes(&mut script, &definitions(), seeded),
        2 => any_text(&mut script),
        _ => whole_messages(&mut script, seeded),
    }
}

fn length(format: &str) -> usize {
    3 + format.bytes().filter_map(Letter::of).map(Letter::bytes).sum::<usize>()
}

/// FMT messages of everything in [`DEFINED`].
fn definitions() -> Vec<u8> {
    let defined = [(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")];
    let mut bytes = Vec::new();
    for (number, name, format, fields) in defined.into_iter().chain(DEFINED) {
        bytes.extend([0xa3, 0x95, 128, number, u8::try_from(length(format)).unwrap_or(u8::MAX)]);
        for (text, padded) in [(name, 4), (format, 16), (fields, 64)] {
            let end = bytes.len() + padded;
            bytes.extend(text.as_bytes());
            bytes.resize(end, 0);
        }
    }
    bytes
}

#[derive(Debug, PartialEq)]
struct Got {
    messages: Vec<(usize, usize)>,
    damage: DataflashDamage,
}

fn read(bytes: &[u8], piece: usize, seeded: bool) -> Got {
    let mut reader = DataflashReader::new(Trickle { left: bytes, piece });
    let mut messages = Vec::new();
    while let Some(message) = reader.next_message().expect("bytes in memory can be read") {
        let at = usize::try_from(message.offset).expect("an offset in memory");
        // the seeded bug: the messages of a seventeenth motor are lost
        let overlooked = seeded && message.definition.name == "ESC" && message.number(1) == 16.0;
        if !overlooked {
            messages.push((at, message.definition.bytes));
        }
    }
    Got { messages, damage: reader.damage().clone() }
}

/// Every byte is a message's or counted, messages do not overlap, pieces do not matter, and what comes out is a recording.
fn any_bytes(script: &mut Bytes<'_>, front: &[u8], seeded: bool) {
    let piece = usize::from(script.u8()) + 1;
    let bytes = [front, script.rest()].concat();
    let got = read(&bytes, usize::MAX, seeded);
    let (mut end, mut told) = (0, 0);
    for (at, length) in &got.messages {
        assert!(*at >= end, "messages do not overlap");
        end = at + length;
        told += *length as u64;
        assert_eq!(bytes.get(*at..at + 2), Some(&[0xa3, 0x95][..]), "a message begins with its marker");
    }
    let Got { damage, messages } = &got;
    assert!(end <= bytes.len());
    assert_eq!((damage.bytes, damage.messages), (bytes.len() as u64, messages.len() as u64));
    assert_eq!(told + damage.skipped_bytes + damage.tail_bytes, damage.bytes, "{damage:?}");
    assert_eq!(read(&bytes, piece, seeded), got, "in pieces of {piece} bytes");
    through_the_door(&bytes);
}

fn through_the_door(bytes: &[u8]) {
    match log::open(Input::Bytes { name: "bytes", bytes }, &OpenOptions::default()) {
        Ok(opened) => is_sound(&opened.recording),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Every line is a message or counted.
fn any_text(script: &mut Bytes<'_>) {
    let mut text = String::new();
    for (number, name, format, fields) in DEFINED {
        text.push_str(&format!("FMT, {number}, {}, {name}, {format}, {fields}\n", length(format)));
    }
    let bytes = [text.as_bytes(), script.rest()].concat();
    let mut reader = DataflashTextReader::new(bytes.as_slice());
    let mut messages = 0;
    while let Some(message) = reader.next_message().expect("bytes in memory can be read") {
        messages += 1;
        assert!((0..message.definition.fields.len()).all(|field| !message.text(field).contains('\n')));
    }
    let damage = reader.damage();
    assert_eq!((damage.messages, damage.bytes), (messages, bytes.len() as u64));
    assert!(messages >= DEFINED.len() as u64);
    through_the_door(&bytes);
}

/// Every whole message is given, whatever stands in it, and a torn one at the end is counted.
fn whole_messages(script: &mut Bytes<'_>, seeded: bool) {
    let mut bytes = definitions();
    let mut whole: Vec<(usize, usize)> = Vec::new();
    let torn = usize::from(script.u8());
    let mut stamp_us = 40_000_000_u64;
    while !script.is_empty() {
        let (number, _, format, _) = script.one_of(&DEFINED);
        stamp_us += u64::from(script.u16());
        let (start, length) = (bytes.len(), length(format));
        bytes.extend([0xa3, 0x95, number]);
        bytes.extend(stamp_us.to_le_bytes());
        let piece = script.piece();
        bytes.extend(&piece[..piece.len().min(start + length - bytes.len())]);
        bytes.resize(start + length, 0);
        whole.push((start, length));
    }
    let Some((_, last)) = whole.last().copied() else { return };
    // at least a byte of the last one stays, and at least one is torn off where any is
    let cut = torn % last;
    bytes.truncate(bytes.len() - cut);
    whole.truncate(whole.len() - usize::from(cut > 0));
    let got = read(&bytes, usize::MAX, seeded);
    // in what is left of a torn one a whole message may stand
    let first = 1 + DEFINED.len();
    let given = got.messages.get(first..first + whole.len());
    assert_eq!(given, Some(whole.as_slice()), "{:?}", got.damage);
    through_the_door(&bytes);
}
