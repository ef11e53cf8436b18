//! Signatures: only what was signed with the key, and is new, is believed; keys and times kept in files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use mavid::link::{Distrust, Signing, SigningError, SigningKey};
use mavid::wire::{Check, ComponentId, SystemId};

use super::bytes::Bytes;
use super::frames::{From, SEEDS, frame, signed, v2};

/// Signing time, units of 10 us since 2015, of the year 2027.
const NOW: u64 = 40_000_000_000_000;
const SECOND: u64 = 100_000;
/// A stream not heard before may be a minute behind.
const STALE: u64 = 6_000_000;
/// 89 years of signing time fit its 48 bits; clocks stay well below.
const LATEST: u64 = 1 << 47;
const RADIO_STATUS: u32 = 109;
const IDS: [u32; 4] = [0, 30, 76, RADIO_STATUS];

/// A conversation with forgeries, or files of a key and of times.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    match script.u8() % 8 {
        0 => files(script),
        _ => conversation(script, seeded),
    }
}

/// What a receiver has to know: a model of its memory, written anew from the words of MAVLink's page on signing.
#[derive(Debug)]
struct Memory {
    own: u64,
    streams: BTreeMap<(u8, SystemId, ComponentId), u64>,
}

impl Memory {
    /// Whether a frame with a right signature is believed, by the time read from it.
    fn judge(&mut self, bytes: &[u8], now: u64) -> Result<(), Distrust> {
        let (header, time) = (*frame(bytes).header(), time_of(bytes));
        let stream = (bytes[bytes.len() - 13], header.system, header.component);
        self.own = self.own.max(now);
        match self.streams.get(&stream) {
            Some(last) if time <= *last => return Err(Distrust::Replayed),
            None if time + STALE < self.own => {
                return Err(Distrust::Old { behind_s: (self.own - time) / SECOND });
            }
            _ => {}
        }
        self.streams.insert(stream, time);
        self.own = self.own.max(time);
        Ok(())
    }
}

fn time_of(bytes: &[u8]) -> u64 {
    let tail = &bytes[bytes.len() - 12..bytes.len() - 6];
    tail.iter().rev().fold(0, |time, byte| time << 8 | u64::from(*byte))
}

/// Frames signed with the same or another key, tampered with, replayed, delayed, or not signed at all, at a receiver
/// whose clock goes as the script says.
fn conversation(mut script: Bytes<'_>, seeded: bool) {
    let receiver = Signing::with_key_at(SigningKey::from_bytes([1; 32]), NOW);
    let keys = [1, 2].map(|byte| SigningKey::from_bytes([byte; 32]));
    let mut memory = Memory { own: NOW, streams: BTreeMap::new() };
    let (mut now, mut sequence) = (NOW, 0_u8);
    let mut honest: Vec<Vec<u8>> = Vec::new();
    while !script.is_empty() {
        let what = script.u8();
        let from = From { sender: (script.u8() % 4 + 1, script.u8() % 2), sequence };
        sequence = sequence.wrapping_add(1);
        let (id, payload) = (script.one_of(&IDS), script.piece());
        let mut bytes = match what % 8 {
            0 => v2(id, from, payload),
            1 if !honest.is_empty() => honest[usize::from(script.u8()) % honest.len()].clone(),
            2 => {
                now = (now + u64::from(script.u32())).min(LATEST);
                continue;
            }
            3 => {
                now = now.saturating_sub(script.u32().into());
                continue;
            }
            _ => {
                let mut bytes = signed(id, from, payload);
                let at = now.saturating_add_signed(i64::from(i32::from_le_bytes(script.array())) >> 4);
                let stranger = what & 0x40 != 0;
                let sender = Signing::with_key_at(keys[usize::from(stranger)].clone(), 0);
                sender.for_link(script.u8() % 3).sign_at(&mut bytes, at);
                if !stranger && !honest.contains(&bytes) {
                    honest.push(bytes.clone());
                }
                bytes
            }
        };
        if what & 0x80 != 0 {
            // behind the length and the flags, which say where the frame ends
            let at = 3 + usize::from(script.u8()) % (bytes.len() - 3);
            bytes[at] ^= 1 << (script.u8() % 8);
        }
        let genuine = honest.contains(&bytes);
        let mut verdict = receiver.verify_at(&frame(&bytes), now);
        let header = *frame(&bytes).header();
        if seeded && verdict == Err(Distrust::Replayed) && header.system.0 == 3 && now < NOW {
            verdict = Ok(());
        }
        let expected = match (header.is_signed(), genuine) {
            (false, _) if header.message_id == RADIO_STATUS => Ok(()),
            (false, _) => Err(Distrust::Unsigned),
            (true, false) => Err(Distrust::Wrong),
            (true, true) => memory.judge(&bytes, now),
        };
        assert_eq!(verdict, expected, "{bytes:02x?} at {now}, {memory:?}");
        assert!(!(genuine && frame(&bytes).check(&SEEDS) != Check::Right), "a genuine frame is whole");
    }
}

/// A folder of this process alone, in memory where the system has such a place.
fn folder() -> PathBuf {
    let memory = PathBuf::from("/dev/shm");
    let base = if memory.is_dir() { memory } else { std::env::temp_dir() };
    base.join(format!("mavid-fuzz-signing-{}-{:?}", std::process::id(), std::thread::current().id()))
}

/// Files of a key and of times are read or refused with words; read, time goes on behind what the file says.
fn files(mut script: Bytes<'_>) {
    let has_times = !script.u8().is_multiple_of(4);
    let key = script.piece();
    let times = script.rest();
    let folder = folder();
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("key");
    std::fs::write(&file, key).expect("a file");
    let of_times = folder.join("key.times");
    match has_times {
        true => std::fs::write(&of_times, times).expect("a file"),
        false => drop(std::fs::remove_file(&of_times)),
    }
    match Signing::open(&file) {
        Ok(signing) => {
            let mut bytes = signed(0, From { sender: (255, 190), sequence: 0 }, &[3; 9]);
            signing.sign_at(&mut bytes, 0);
            assert!(frame(&bytes).header().is_signed());
            drop(signing);
            // what was written at the end can be read again
            Signing::open(&file).expect("times that the program wrote");
        }
        Err(SigningError::File { what: "read", .. }) if std::str::from_utf8(times).is_err() => {}
        Err(error @ (SigningError::Key { .. } | SigningError::Times { .. })) => {
            assert!(error.to_string().contains("expected"), "{error}");
        }
        Err(error) => panic!("an error that these files cannot have: {error}"),
    }
    let _ = std::fs::remove_dir_all(&folder);
}
