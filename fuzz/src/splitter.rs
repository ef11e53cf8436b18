//! Frames told from the bytes of a link.

use mavid::wire::{Check, Frame, SplitCounts, Splitter, Version};

use super::bytes::Bytes;
use super::frames::{From, SEEDS, UNKNOWN_ID, VEHICLE, frame, signed, v1, v2};

/// HEARTBEAT, PARAM_VALUE, ATTITUDE, COMMAND_LONG, ENCAPSULATED_DATA (255 bytes), TUNNEL.
const IDS: [u32; 6] = [0, 22, 30, 76, 131, 385];
const SENDERS: [(u8, u8); 2] = [VEHICLE, (255, 190)];
/// The number at which the seeded bug loses a MAVLink 1 frame.
const LOST: u8 = 0x5A;

/// Any bytes, whole frames in all combinations, or noise before whole frames.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    match script.u8() % 3 {
        0 => any_bytes(script, seeded),
        1 => whole_frames(script, seeded),
        _ => noise_before_frames(script, seeded),
    }
}

struct Split {
    frames: Vec<Vec<u8>>,
    counts: SplitCounts,
}

/// All frames of the bytes, fed in pieces of `piece` bytes.
fn split(bytes: &[u8], piece: usize, seeded: bool) -> Split {
    let mut splitter = Splitter::new();
    let mut frames = Vec::new();
    let mut take = |splitter: &mut Splitter| {
        while let Some(frame) = splitter.next_frame() {
            let header = frame.header();
            if seeded && header.version == Version::V1 && header.sequence == LOST && header.message_id == 30 {
                continue;
            }
            frames.push(frame.bytes().to_vec());
        }
    };
    for piece in bytes.chunks(piece.max(1)) {
        splitter.feed(piece);
        take(&mut splitter);
    }
    splitter.flush();
    take(&mut splitter);
    Split { frames, counts: *splitter.counts() }
}

/// What holds of whatever comes: every byte is a frame's or counted, and the pieces do not matter.
fn any_bytes(mut script: Bytes<'_>, seeded: bool) {
    let piece = usize::from(script.u8());
    let bytes = script.rest();
    let whole = split(bytes, bytes.len(), seeded);
    let mut at = 0;
    for given in &whole.frames {
        let found = bytes[at..].windows(given.len()).position(|window| window == given);
        at += found.expect("a frame is given as it came, in the order of the bytes") + given.len();
        assert_ne!(frame(given).check(&SEEDS), Check::Wrong, "a wrong checksum is given out");
    }
    let counts = whole.counts;
    let given: usize = whole.frames.iter().map(Vec::len).sum();
    assert_eq!(counts.frames, whole.frames.len() as u64);
    assert_eq!(given as u64 + counts.skipped_bytes, bytes.len() as u64, "every byte is accounted for");
    let unknown = whole.frames.iter().filter(|given| frame(given).check(&SEEDS) == Check::UnknownMessage);
    assert_eq!(counts.unknown, unknown.count() as u64);
    let pieces = split(bytes, piece, seeded);
    assert_eq!(pieces.frames, whole.frames, "in pieces of {piece} bytes");
    assert_eq!(pieces.counts, counts, "in pieces of {piece} bytes");
}

/// What became of a frame on its way.
#[derive(PartialEq, Clone, Copy)]
enum Fate {
    Sound,
    Broken,
}

/// A frame by the script, perhaps with a whole other one in its payload (rust-mavlink#508), perhaps as short as
/// MAVLink 2 allows of a long message (mavlink#2555).
fn scripted(script: &mut Bytes<'_>, may_break: bool) -> (Vec<u8>, Fate) {
    let kind = script.u8();
    let from = From { sender: script.one_of(&SENDERS), sequence: script.u8() };
    let id = script.one_of(&IDS);
    let mut payload = script.piece().to_vec();
    if kind & 0x40 != 0 {
        let fake =
            v2(0, From { sender: from.sender, sequence: script.u8() }, &[0, 0, 6, 0, 2, 12, 0x81, 4, 3]);
        payload.truncate(255 - fake.len() - 2);
        let at = usize::from(script.u8()) % (payload.len() + 1);
        payload.splice(at..at, fake);
        // it ends before its carrier does
        payload.extend([0x11, 0x11]);
    }
    let mut bytes = match kind % 4 {
        0 => v1(u8::try_from(id).unwrap_or(30), from, &payload),
        1 => signed(id, from, &payload),
        2 if may_break => v2(UNKNOWN_ID, from, &payload),
        _ => v2(id, from, &payload),
    };
    if may_break && kind & 0x80 != 0 && kind % 4 == 3 {
        let end = bytes.len();
        bytes[end - 1] ^= 0x55;
        return (bytes, Fate::Broken);
    }
    (bytes, Fate::Sound)
}

/// Whole frames of known senders, nothing between them: what is sound is given and no packet in a packet is.
fn whole_frames(mut script: Bytes<'_>, seeded: bool) {
    let piece = usize::from(script.u8());
    let mut sent: Vec<(Vec<u8>, Fate)> = SENDERS
        .iter()
        .map(|sender| (v2(30, From { sender: *sender, sequence: 0 }, &[7; 28]), Fate::Sound))
        .collect();
    while !script.is_empty() {
        sent.push(scripted(&mut script, true));
    }
    let bytes: Vec<u8> = sent.iter().flat_map(|(bytes, _)| bytes.iter().copied()).collect();
    if runs_across_by_chance(&bytes, &sent) {
        return;
    }
    let given = split(&bytes, piece, seeded);
    let sound: Vec<&Vec<u8>> =
        sent.iter().filter(|(_, fate)| *fate == Fate::Sound).map(|(bytes, _)| bytes).collect();
    assert!(given.frames.iter().eq(sound.iter().copied()), "sent {sound:02x?}, given {:02x?}", given.frames);
    assert_eq!(given.counts.bad_crc, (sent.len() - sound.len()) as u64);
}

/// A frame with a right checksum begins inside of a sent one and ends behind it: no sender made it, and among
/// 65 536 places that look like a header one has such a checksum. Nothing tells it from a frame behind noise.
fn runs_across_by_chance(bytes: &[u8], sent: &[(Vec<u8>, Fate)]) -> bool {
    let mut start = 0;
    sent.iter().any(|(frame, _)| {
        let end = start + frame.len();
        let across = (start + 1..end).any(|at| {
            Frame::at_start(&bytes[at..])
                .is_some_and(|inside| at + inside.bytes().len() > end && inside.check(&SEEDS) == Check::Right)
        });
        start = end;
        across
    })
}

/// Noise, whatever it looks like, costs none of the frames behind it (rust-mavlink#508, the other way).
fn noise_before_frames(mut script: Bytes<'_>, seeded: bool) {
    let piece = usize::from(script.u8());
    let mut bytes = script.piece().to_vec();
    let mut sent = Vec::new();
    while !script.is_empty() {
        sent.push(scripted(&mut script, false).0);
    }
    bytes.extend(sent.iter().flatten());
    let given = split(&bytes, piece, seeded).frames;
    assert!(given.ends_with(&sent), "sent {sent:02x?}, given {given:02x?}");
}
