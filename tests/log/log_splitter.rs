//! The splitter against what is known to go wrong when MAVLink frames are told from bytes.

use crate::support;

use mavid::wire::{Check, CrcSeeds, SplitCounts, Splitter, Version};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use support::{UNKNOWN_ID, attitude, attitudes, by_hand, header, heartbeat, signed, unknown, v1, v2};

/// All frames in the bytes, fed in pieces of `piece` bytes.
fn split_in_pieces(bytes: &[u8], piece: usize) -> (Vec<Vec<u8>>, SplitCounts) {
    let mut splitter = Splitter::new();
    let mut frames = Vec::new();
    for piece in bytes.chunks(piece) {
        splitter.feed(piece);
        while let Some(frame) = splitter.next_frame() {
            frames.push(frame.bytes().to_vec());
        }
    }
    splitter.flush();
    while let Some(frame) = splitter.next_frame() {
        frames.push(frame.bytes().to_vec());
    }
    (frames, *splitter.counts())
}

fn split(bytes: &[u8]) -> (Vec<Vec<u8>>, SplitCounts) {
    split_in_pieces(bytes, bytes.len().max(1))
}

#[test]
fn unknown_ids_are_kept() {
    let mut sent = attitudes(5);
    sent[1] = unknown(1, &[1, 2, 3]);
    sent[3] = unknown(3, &[4; 200]);
    let (frames, counts) = split(&sent.concat());
    assert_eq!(frames, sent);
    assert_eq!((counts.frames, counts.unknown, counts.skipped_bytes), (5, 2, 0));
}

#[test]
fn a_packet_inside_an_unknown_frame_is_not_delivered() {
    let fake = v2(header(1, 9), &heartbeat());
    for (before, after) in [(&[][..], &[][..]), (&[7, 0xFE, 7], &[7; 20]), (&[], &[0xFD, 0xFE, 1])] {
        let carrier = unknown(1, &[before, &fake, after].concat());
        let sent = [v2(header(1, 0), &heartbeat()), carrier, v2(header(1, 2), &attitude(5))];
        assert_eq!(split(&sent.concat()).0, sent, "behind {before:?}, before {after:?}");
    }
}

#[test]
fn a_packet_inside_an_unknown_frame_is_not_delivered_before_noise_either() {
    let fake = v2(header(1, 9), &heartbeat());
    let carrier = unknown(1, &[&[5; 30], &fake[..], &[5; 30]].concat());
    let bytes = [&v2(header(1, 0), &heartbeat()), &carrier, &[0x11; 40][..], &v2(header(1, 2), &attitude(5))]
        .concat();
    assert!(!split(&bytes).0.contains(&fake));
}

#[test]
fn a_packet_inside_a_frame_with_a_wrong_checksum_is_not_delivered() {
    let fake = v2(header(1, 9), &heartbeat());
    let mut carrier = by_hand(385, 0, 1, &[&[1, 1, 0, 0, 40], &fake[..], &[3; 40]].concat(), 147);
    assert_eq!(split(&carrier).0, [carrier.clone()]); // TUNNEL, whole
    carrier[12] ^= 0x40;
    let sent = [v2(header(1, 0), &heartbeat()), carrier, v2(header(1, 2), &attitude(5))];
    let (frames, counts) = split(&sent.concat());
    assert_eq!(frames, [sent[0].clone(), sent[2].clone()]);
    assert_eq!(counts.bad_crc, 1);
}

/// What looks like a frame of a known sender may end where a packet in the payload of a real one begins. Whether the
/// real one is one is not known before it is whole.
#[test]
fn noise_costs_no_frame_that_comes_byte_by_byte() {
    let fake = v2(header(1, 9), &heartbeat());
    let carrier = by_hand(385, 0, 1, &[&[1, 1, 0, 0, 40], &fake[..], &[3; 40]].concat(), 147);
    let to_the_fake = 10 + 5;
    // the header of a HIGHRES_IMU that ends where the fake begins
    let false_bytes = 12 + 40;
    let mut noise = vec![0x11; false_bytes - to_the_fake];
    noise[..10].copy_from_slice(&[0xFD, 40, 0, 0, 0, 1, 1, 105, 0, 0]);
    let sent = [v2(header(1, 0), &heartbeat()), carrier, v2(header(1, 2), &attitude(5))];
    let bytes = [&sent[0], &noise, &sent[1], &sent[2]].map(Vec::as_slice).concat();
    for piece in [1, 7, bytes.len()] {
        assert_eq!(split_in_pieces(&bytes, piece).0, sent, "in pieces of {piece}");
    }
}

#[test]
fn version_1_frames_are_read_without_asking() {
    let sent =
        [v1(header(1, 0), &heartbeat()), v2(header(1, 1), &heartbeat()), v1(header(1, 2), &attitude(5))];
    assert_eq!(split(&sent.concat()).0, sent);
    assert_eq!(support::frame(&sent[0]).header().version, Version::V1);
}

#[test]
fn signed_frames_are_whole_with_their_signature() {
    let sent = [signed(0, &heartbeat()), signed(1, &attitude(7)), v2(header(1, 2), &attitude(8))];
    let (frames, counts) = split(&sent.concat());
    assert_eq!(frames, sent);
    assert_eq!(counts.skipped_bytes, 0);
    assert!(support::frame(&sent[0]).header().is_signed());
}

#[test]
fn four_byte_system_ids_are_read() {
    let sent = v2(header(70_000, 0), &heartbeat());
    let (frames, _) = split(&sent);
    assert_eq!(frames, [sent]);
    assert_eq!(support::frame(&frames[0]).header().system.0, 70_000);
    assert_eq!(support::frame(&frames[0]).header().message_id, 0);
}

#[test]
fn frames_with_flags_that_nobody_defined_are_not_read() {
    let strange = by_hand(0, 0x80, 0, &[0; 9], 50);
    assert!(split(&strange).0.is_empty());
}

#[test]
fn noise_with_false_markers_before_a_fifth_of_2000_frames_costs_none() {
    let mut random = Pcg64Mcg::seed_from_u64(12);
    let mut sent = Vec::new();
    let mut bytes = Vec::new();
    for index in 0..2000_u32 {
        if index % 5 == 0 {
            let length = random.random_range(1..40);
            bytes.extend((0..length).map(|_| {
                let byte: u8 = random.random();
                if byte < 16 {
                    0xFD
                } else if byte < 32 {
                    0xFE
                } else {
                    byte
                }
            }));
        }
        let sequence = u8::try_from(index % 256).unwrap();
        sent.push(v2(header(1, sequence), &attitude(index * 10)));
        bytes.extend_from_slice(&sent[sent.len() - 1]);
    }
    let (frames, _) = split(&bytes);
    assert_eq!((frames.len(), frames == sent), (2000, true));
}

#[test]
fn bit_flips_cost_only_the_frames_they_hit() {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let mut bytes = Vec::new();
    let mut intact = Vec::new();
    for index in 0..2000_u32 {
        let mut frame = v2(header(1, u8::try_from(index % 256).unwrap()), &attitude(index * 10));
        if random.random_range(0..20) == 0 {
            let bit = random.random_range(0..frame.len() * 8);
            frame[bit / 8] ^= 1 << (bit % 8);
        } else {
            intact.push(frame.clone());
        }
        bytes.extend_from_slice(&frame);
    }
    let (frames, _) = split(&bytes);
    let missing = intact.iter().filter(|frame| !frames.contains(frame)).count();
    assert_eq!(missing, 0);
}

#[test]
fn a_truncated_last_frame_costs_itself_alone() {
    let sent = attitudes(10);
    let bytes = sent.concat();
    assert_eq!(split(&bytes[..bytes.len() - 5]).0, sent[..9]);
}

#[test]
fn an_over_long_payload_of_a_newer_sender_is_read() {
    let longer = by_hand(30, 0, 0, &[1; 40], 39);
    let (frames, _) = split(&longer);
    assert_eq!(frames, [longer]);
}

#[test]
fn a_checked_frame_does_not_wait_for_what_follows() {
    let mut splitter = Splitter::new();
    splitter.feed(&v2(header(1, 0), &heartbeat()));
    assert!(splitter.next_frame().is_some());
}

#[test]
fn an_unknown_frame_waits_for_its_proof_or_for_the_end_of_the_datagram() {
    let mut splitter = Splitter::new();
    splitter.feed(&unknown(0, &[1; 20]));
    assert!(splitter.next_frame().is_none());
    splitter.flush();
    assert_eq!(splitter.next_frame().unwrap().header().message_id, UNKNOWN_ID);
}

proptest! {
    #![proptest_config(support::cases())]

    #[test]
    fn arbitrary_bytes_do_no_harm_and_every_byte_is_accounted_for(
        bytes in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD), Just(0xFE), Just(0)], 0..4000),
        piece in 1_usize..600,
    ) {
        let (frames, counts) = split_in_pieces(&bytes, piece);
        let in_frames: usize = frames.iter().map(Vec::len).sum();
        prop_assert_eq!(in_frames as u64 + counts.skipped_bytes, bytes.len() as u64);
    }

    #[test]
    fn noise_costs_no_frame_behind_it(
        noise in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD), Just(0xFE), Just(0)], 0..400),
        at in 0_usize..10,
        piece in 1_usize..700,
    ) {
        let sent = attitudes(30);
        let bytes = [sent[..at].concat(), noise, sent[at..].concat()].concat();
        let (frames, _) = split_in_pieces(&bytes, piece);
        // one in 65536 false headers has a right checksum by chance: nothing can tell that from a frame
        let seeds = CrcSeeds::new();
        let by_chance = |bytes: &Vec<u8>| support::frame(bytes).check(&seeds) == Check::Right && !sent.contains(bytes);
        prop_assume!(!frames.iter().any(by_chance));
        let found: Vec<_> = frames.into_iter().filter(|frame| sent.contains(frame)).collect();
        prop_assert_eq!(found, sent);
    }
}
