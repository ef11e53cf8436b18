use std::collections::BTreeMap;

use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};

use super::clock::{SECOND, STALE, clock_warning, now};
use super::times::{AHEAD, StreamKey, Times};
use super::{Distrust, ReportedSignatures, Signing, SigningError, SigningKey};
use crate::link::event::LinkEvent;
use crate::wire::{ComponentId, Frame, SystemId};

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
    Signing::new(SigningKey::from_bytes([key; 32]), times, None, Vec::new())
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
fn what_is_not_believed_is_told_once_with_what_to_do() {
    let (receiver, mut told) = (at(1, NOW), ReportedSignatures::default());
    let mut said = |bytes: &[u8], receiver: &Signing| {
        let verdict = verify(receiver, bytes, NOW);
        let events = told.events(&Frame::at_start(bytes).unwrap(), Some(receiver), verdict);
        events.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    let old_version = {
        let mut raw = mavlink::MAVLinkV1MessageRaw::new();
        raw.serialize_message(header(), &heartbeat());
        raw.raw_bytes().to_vec()
    };
    let good = signed(&at(1, NOW), NOW);
    for (bytes, expected) in [
        (unsigned(&heartbeat()), "it does not sign; set the key up on the vehicle"),
        (old_version, "MAVLink 1, which cannot be signed; set its port to MAVLink 2"),
        (signed(&at(2, NOW), NOW), "signs with another key; expected the vehicle's key"),
        (
            signed(&at(1, 0).for_link(3), NOW - 100 * STALE),
            "signs 6000 s in the past, expected at most 60 s; set",
        ),
        (good.clone(), "signs with the key given"),
        (good, "sends what was received before"),
    ] {
        let first = said(&bytes, &receiver);
        assert!(first.starts_with("system 1 component 1 ") && first.contains(expected), "{first}");
        // the good one is heard before the second time, which is told by the next
        if !expected.contains("given") {
            assert_eq!(said(&bytes, &receiver), "", "{expected}");
        }
    }
}

#[test]
fn a_clock_that_is_behind_what_is_heard_is_told() {
    let (receiver, mut told) = (at(1, now()), ReportedSignatures::default());
    let bytes = signed(&at(1, 0), now() + 100 * STALE);
    let frame = Frame::at_start(&bytes).unwrap();
    let verdict = receiver.verify(&frame);
    assert_eq!(verdict, Ok(()));
    let events = told.events(&frame, Some(&receiver), verdict);
    let Some(LinkEvent::ClockBehind { seconds }) = events.last() else { panic!("{events:?}") };
    assert!((5990..=6000).contains(seconds), "{seconds}");
    assert!(clock_warning(100 * STALE).unwrap().contains("6000 s behind the last signing time"));
    assert_eq!(clock_warning(AHEAD), None);
}

#[test]
fn a_vehicle_that_signs_is_told_where_there_is_no_key() {
    let mut told = ReportedSignatures::default();
    let bytes = signed(&at(1, NOW), NOW);
    let events = told.events(&Frame::at_start(&bytes).unwrap(), None, Ok(()));
    let [event @ LinkEvent::Unchecked { .. }] = events.as_slice() else { panic!("{events:?}") };
    assert!(event.to_string().contains("give its key by --signing-key-file"), "{event}");
    assert!(told.events(&Frame::at_start(&bytes).unwrap(), None, Ok(())).is_empty(), "once");
}

#[test]
fn noise_of_many_senders_does_not_flood_who_listens() {
    let (receiver, mut told) = (at(1, NOW), ReportedSignatures::default());
    let mut events = 0;
    for system in 1..=255 {
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(MavHeader { system_id: system, ..header() }, &heartbeat());
        let frame = Frame::at_start(raw.raw_bytes()).unwrap();
        events += told.events(&frame, Some(&receiver), Err(Distrust::Unsigned)).len();
    }
    assert_eq!(events, 32);
}

#[test]
fn a_new_stream_may_be_a_minute_behind_and_no_more() {
    let frame = |time| signed(&at(1, time - 1), time);
    assert_eq!(verify(&at(1, NOW), &frame(NOW - STALE), NOW), Ok(()));
    assert_eq!(verify(&at(1, NOW), &frame(NOW - STALE - 1), NOW), Err(Distrust::Old { behind_s: 60 }));
    // our time follows the latest heard: a minute before that is old, whatever our clock says
    let receiver = at(1, NOW);
    assert_eq!(verify(&receiver, &frame(NOW + 10 * STALE), NOW), Ok(()));
    let other = signed(&at(1, NOW).for_link(5), NOW + STALE);
    assert_eq!(verify(&receiver, &other, NOW), Err(Distrust::Old { behind_s: 540 }));
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

#[test]
fn a_stream_of_an_earlier_run_is_held_to_the_minute_again() {
    let sender = at(1, NOW);
    let receiver = at(1, NOW);
    let last = signed(&sender, NOW);
    assert_eq!(verify(&receiver, &last, NOW), Ok(()));
    // signed after our run, recorded by somebody, played back a day later to the next
    let between = signed(&sender, NOW + 10 * SECOND);
    let later = signed(&sender, NOW + 20 * SECOND);
    let key = StreamKey { link: 0, system: SystemId(1), component: ComponentId(1) };
    let streams = BTreeMap::from([(key, NOW + 1)]);
    let day = 24 * 60 * STALE;
    let again = |now| {
        let times = Times { own: now, streams: streams.clone() };
        Signing::new(SigningKey::from_bytes([1; 32]), times, None, Vec::new())
    };
    let next = again(NOW + day);
    assert!(matches!(verify(&next, &between, NOW + day), Err(Distrust::Old { behind_s: 86_390 })));
    // the vehicle itself, once its clock is set, and from then on by order alone
    assert_eq!(verify(&next, &signed(&sender, NOW + day), NOW + day), Ok(()));
    let slow = signed(&sender, 0);
    assert_eq!(verify(&next, &slow, NOW + 2 * day), Ok(()), "its clock may stand still while it is heard");
    assert_eq!(verify(&next, &later, NOW + 2 * day), Err(Distrust::Replayed));
    // within the minute the next run takes up the stream, but not what was heard before it
    let soon = again(NOW + 15 * SECOND);
    assert_eq!(verify(&soon, &last, NOW + 15 * SECOND), Err(Distrust::Replayed));
    assert_eq!(verify(&soon, &between, NOW + 15 * SECOND), Ok(()));
}
