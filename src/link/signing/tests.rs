use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};

use super::*;

const NOW: u64 = 40_000_000_000_000;

fn radio_status() -> MavMessage {
    MavMessage::RADIO_STATUS(dialect::RADIO_STATUS_DATA::default())
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA { mavlink_version: 3, ..Default::default() })
}

fn header() -> MavHeader {
    MavHeader { system_id: 1, component_id: 1, sequence: 0 }
}

fn unsigned(message: &MavMessage) -> Vec<u8> {
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message(header(), message);
    raw.raw_bytes().to_vec()
}

fn signed(by: &Signing, now: u64) -> Vec<u8> {
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message_for_signing(header(), &heartbeat());
    let mut bytes = raw.raw_bytes().to_vec();
    by.sign_at(&mut bytes, now);
    bytes
}

fn at(key: u8, own: u64) -> Signing {
    let times = Times { own, ..Times::default() };
    Signing::new(SigningKey::from_bytes([key; 32]), times, None)
}

fn verify(by: &Signing, bytes: &[u8], now: u64) -> Result<(), Distrust> {
    by.verify_at(&Frame::at_start(bytes).unwrap(), now)
}

#[test]
fn a_signed_frame_is_believed_once() {
    let (sender, receiver) = (at(1, NOW), at(1, NOW));
    let first = signed(&sender, NOW);
    let second = signed(&sender, NOW);
    assert_eq!(verify(&receiver, &second, NOW), Ok(()));
    assert_eq!(verify(&receiver, &second, NOW), Err(Distrust::Replayed));
    // older on the same stream, though within the minute
    assert_eq!(verify(&receiver, &first, NOW), Err(Distrust::Replayed));
    // another link of the same sender has times of its own
    assert_eq!(verify(&receiver, &signed(&sender.for_link(1), NOW), NOW), Ok(()));
}

#[test]
fn the_mavlink_crate_makes_the_same_signature() {
    let bytes = signed(&at(9, NOW), NOW);
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message_for_signing(header(), &heartbeat());
    raw.signature_timestamp_bytes_mut().copy_from_slice(&(NOW + 1).to_le_bytes()[..6]);
    let mut signature = [0; 6];
    raw.calculate_signature(&[9; 32], &mut signature);
    assert_eq!(bytes[bytes.len() - 6..], signature);
}

#[test]
fn every_changed_bit_and_another_key_is_told() {
    let bytes = signed(&at(1, NOW), NOW);
    assert_eq!(verify(&at(2, NOW), &bytes, NOW), Err(Distrust::Wrong));
    // behind the length and flags, which change where the frame ends
    for index in 3..bytes.len() {
        for bit in 0..8 {
            let mut changed = bytes.clone();
            changed[index] ^= 1 << bit;
            assert_eq!(verify(&at(1, NOW), &changed, NOW), Err(Distrust::Wrong), "byte {index}, bit {bit}");
        }
    }
}

#[test]
fn only_a_radios_report_needs_no_signature() {
    let receiver = at(1, NOW);
    assert_eq!(verify(&receiver, &unsigned(&heartbeat()), NOW), Err(Distrust::Unsigned));
    assert_eq!(verify(&receiver, &unsigned(&radio_status()), NOW), Ok(()));
}

#[test]
fn a_new_stream_may_be_a_minute_behind_and_no_more() {
    let frame = |time| signed(&at(1, time - 1), time);
    assert_eq!(verify(&at(1, NOW), &frame(NOW - STALE), NOW), Ok(()));
    assert_eq!(verify(&at(1, NOW), &frame(NOW - STALE - 1), NOW), Err(Distrust::Replayed));
    // our time follows the latest heard: a minute before that is old, whatever our clock says
    let receiver = at(1, NOW);
    assert_eq!(verify(&receiver, &frame(NOW + 10 * STALE), NOW), Ok(()));
    let other = signed(&at(1, NOW).for_link(5), NOW + STALE);
    assert_eq!(verify(&receiver, &other, NOW), Err(Distrust::Replayed));
}

#[test]
fn time_goes_on_over_a_restart_with_the_clock_set_back() {
    let folder = std::env::temp_dir().join(format!("mavid-signing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let key = folder.join("key");
    std::fs::write(&key, "a passphrase\n").unwrap();
    let first = Signing::open(&key).unwrap();
    let heard = signed(&Signing::open(&key).unwrap().for_link(7), now() + 5 * STALE);
    assert_eq!(verify(&first, &heard, now()), Ok(()));
    let last = signed(&first, now());
    drop(first);
    let second = Signing::open(&key).unwrap();
    assert_eq!(verify(&second, &heard, 0), Err(Distrust::Replayed));
    let after = signed(&second, 0);
    let time =
        |bytes: &[u8]| bytes[bytes.len() - 12..bytes.len() - 6].iter().rev().copied().collect::<Vec<_>>();
    assert!(time(&after) > time(&last));
    drop(second);
    std::fs::write(folder.join("key.times"), "nonsense").unwrap();
    assert!(matches!(Signing::open(&key), Err(SigningError::Times { line: 1, .. })));
    std::fs::remove_file(folder.join("key.times")).unwrap();
    // a process that was killed kept nothing more than the file says: time is ahead of what it used
    let killed = Signing::open(&key).unwrap();
    let used = signed(&killed, now());
    std::mem::forget(killed);
    assert!(time(&signed(&Signing::open(&key).unwrap(), 0)) > time(&used));
    // the forgotten one may still be writing
    let _ = std::fs::remove_dir_all(&folder);
}
