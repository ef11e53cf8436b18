//! The telemetry-log reader against every fault that such files are known to have.

use crate::support;

use mavid::log::{LogError, Resync, TlogReader};
use mavid::wire::{ByteOrder, ComponentId, STAMP_BYTES, SystemId, TlogWriter};
use proptest::prelude::*;
use support::{
    START_US, UNKNOWN_ID, attitude, attitudes, frames, header, heartbeat, read, record, signed, tlog,
    unknown, v1, v2,
};

#[test]
fn stamps_that_end_in_a_marker_cost_no_frame() {
    let sent = attitudes(20);
    for marker in [0xFD, 0xFE] {
        let stamp = |index: u64| (START_US & !0xFF) + index * 256 + marker;
        let bytes: Vec<u8> =
            (0_u64..).zip(&sent).flat_map(|(index, frame)| record(stamp(index), frame)).collect();
        let (records, report) = read(&bytes);
        assert_eq!(frames(&records), sent);
        assert_eq!(records[19].0, stamp(19));
        assert!(report.is_undamaged());
    }
}

#[test]
fn both_versions_mixed_signed_and_unknown_frames_are_kept_to_the_byte() {
    let sent = vec![
        v1(header(1, 0), &heartbeat()),
        v2(header(1, 1), &heartbeat()),
        unknown(2, &[9; 100]),
        signed(3, &attitude(5)),
        unknown(4, &[]),
    ];
    let (records, report) = read(&tlog(&sent));
    assert_eq!(frames(&records), sent);
    assert_eq!((report.frames_v1, report.frames_v2, report.signed), (1, 4, 1));
    assert_eq!(report.unknown_ids[&UNKNOWN_ID], 2);
    assert!(report.is_undamaged());
}

#[test]
fn several_frames_behind_one_stamp() {
    let sent = attitudes(6);
    let bytes = [
        record(START_US, &sent[..3].concat()),
        record(START_US + 9, &sent[3]),
        sent[4].clone(),
        sent[5].clone(),
    ]
    .concat();
    let (records, report) = read(&bytes);
    assert_eq!(frames(&records), sent);
    assert_eq!(records.iter().map(|record| record.0 - START_US).collect::<Vec<_>>(), [0, 0, 0, 9, 9, 9]);
    assert_eq!((report.shared_stamps, report.resync_count), (4, 0));
}

#[test]
fn backward_and_jumping_stamps_keep_the_order_of_the_file() {
    let sent = attitudes(4);
    let year_us = 365 * 86_400 * 1_000_000;
    let stamps = [START_US, START_US - 5_000_000, START_US + year_us, START_US + year_us];
    let bytes: Vec<u8> = stamps.iter().zip(&sent).flat_map(|(stamp, frame)| record(*stamp, frame)).collect();
    let (records, report) = read(&bytes);
    assert_eq!(records.iter().map(|record| record.0).collect::<Vec<_>>(), stamps);
    assert_eq!(frames(&records), sent);
    assert_eq!(report.backward_stamps, 1);
    assert!(report.is_undamaged());
}

#[test]
fn two_logs_concatenated() {
    let sent = attitudes(5);
    let later: Vec<u8> = sent.iter().flat_map(|frame| record(START_US - 9_000_000_000_000, frame)).collect();
    let (records, report) = read(&[tlog(&sent), later].concat());
    assert_eq!(records.len(), 10);
    assert_eq!((report.backward_stamps, report.resync_count), (1, 0));
}

#[test]
fn little_endian_stamps_are_told_by_the_first_records() {
    let sent = attitudes(10);
    let bytes: Vec<u8> = (0_u64..)
        .zip(&sent)
        .flat_map(|(index, frame)| [&(START_US + index * 1000).to_le_bytes()[..], frame].concat())
        .collect();
    let (records, report) = read(&bytes);
    assert_eq!(report.byte_order, ByteOrder::Little);
    assert_eq!(records[9], (START_US + 9000, sent[9].clone()));
}

#[test]
fn the_low_bits_of_a_stamp_are_a_link_number_and_stay() {
    let (records, _) = read(&record(START_US + 3, &attitudes(1)[0]));
    assert_eq!(records[0].0, START_US + 3);
}

#[test]
fn a_truncated_tail_ends_the_log() {
    let sent = attitudes(10);
    let bytes = tlog(&sent);
    let whole = bytes.len() - sent[9].len() - STAMP_BYTES;
    for left in [1, 7, 8, 9, 20, sent[9].len() + STAMP_BYTES - 1] {
        let (records, report) = read(&bytes[..whole + left]);
        assert_eq!(frames(&records), sent[..9], "{left} bytes of the last record");
        assert_eq!((report.truncated_tail_bytes, report.resync_count), (left as u64, 0), "{left}");
    }
}

/// Whatever kind of record a power cut tears, at whatever byte: all before it is given.
#[test]
fn a_torn_last_record_costs_itself_alone() {
    let last = [
        v1(header(1, 9), &attitude(9)),
        v2(header(1, 9), &heartbeat()),
        signed(9, &attitude(9)),
        unknown(9, &[7; 60]),
    ];
    for last in last {
        let sent = attitudes(9);
        let whole = tlog(&sent);
        let torn = record(START_US + 100_000, &last);
        for left in 1..torn.len() {
            let (records, report) = read(&[&whole[..], &torn[..left]].concat());
            assert_eq!(frames(&records), sent, "{left} of {} bytes", torn.len());
            let lost = report.truncated_tail_bytes + report.skipped_bytes;
            assert_eq!(lost, left as u64, "{left} of {} bytes", torn.len());
            assert!(!report.losses().is_empty());
        }
    }
}

/// Ten years, in microseconds.
const TEN_YEARS_US: u64 = 10 * 365 * 86_400 * 1_000_000;

/// A computer without a clock of its own begins in 1970, or with the day when it was switched off, and is set when it
/// finds the network; every frame is given, damage in the midst or not.
#[test]
fn a_clock_that_is_ten_years_off_or_set_on_the_way_costs_no_frame() {
    let sent = attitudes(40);
    let at = |index: usize, start_us: u64| record(start_us + 10_000 * index as u64, &sent[index]);
    for (before_us, behind_us) in [
        (START_US - TEN_YEARS_US, START_US),
        (START_US, START_US + TEN_YEARS_US),
        (START_US, START_US - TEN_YEARS_US),
        (3_000_000, START_US),
        (START_US, 3_000_000),
        (5_000_000_000_000_000, 7_000_000),
    ] {
        let first: Vec<u8> = (0..20).flat_map(|index| at(index, before_us)).collect();
        let second: Vec<u8> = (20..40).flat_map(|index| at(index, behind_us)).collect();
        let (records, report) = read(&[first.clone(), second.clone()].concat());
        assert_eq!(frames(&records), sent, "{before_us} then {behind_us}");
        assert!(report.is_undamaged());
        assert_eq!(report.leaping_stamps + report.backward_stamps, 1);
        let odd = [before_us, behind_us].iter().filter(|us| !(1 << 50..1 << 52).contains(*us)).count();
        assert_eq!(report.odd_stamps, 20 * odd as u64);
        assert_eq!(
            !report.oddities().is_empty(),
            odd > 0 || behind_us < before_us,
            "{:?}",
            report.oddities()
        );
        // the same with noise where the clock was set
        let noise: Vec<u8> = (0..200_u32).map(|index| (index * 37 % 251).to_le_bytes()[0]).collect();
        let (records, report) = read(&[first, noise, second].concat());
        assert_eq!(frames(&records), sent, "{before_us}, noise, {behind_us}");
        assert_eq!(report.skipped_bytes, 200);
    }
}

#[test]
fn doubled_and_reordered_stamps_cost_no_frame_and_are_counted() {
    let sent = attitudes(8);
    let stamps = [0_u64, 100, 100, 100, 40, 5_000_000, 120, 5_000_000];
    let bytes: Vec<u8> =
        stamps.iter().zip(&sent).flat_map(|(stamp, frame)| record(START_US + stamp, frame)).collect();
    let (records, report) = read(&bytes);
    assert_eq!(frames(&records), sent);
    assert_eq!(records.iter().map(|record| record.0 - START_US).collect::<Vec<_>>(), stamps);
    assert_eq!((report.doubled_stamps, report.backward_stamps, report.backward_most_us), (2, 2, 4_999_880));
    let told: Vec<String> = report.oddities().iter().map(ToString::to_string).collect();
    assert_eq!(told, ["2 host stamps run backwards, by 5.000 s at most"]);
    assert!(report.losses().is_empty(), "no frame is lost");
}

#[test]
fn a_tail_of_zeros_ends_the_log() {
    let sent = attitudes(10);
    for zeros in [1, 8, 9, 4096, 700_000] {
        let (records, report) = read(&[tlog(&sent), vec![0; zeros]].concat());
        assert_eq!(frames(&records), sent);
        assert_eq!((report.truncated_tail_bytes, report.resync_count), (zeros as u64, 0));
    }
}

#[test]
fn junk_is_skipped_to_the_next_record_and_counted_with_its_place() {
    let sent = attitudes(10);
    let before = tlog(&sent[..4]);
    let junk: Vec<u8> = (0..333_u32).map(|index| (index * 7 % 251).to_le_bytes()[0]).collect();
    let (records, report) = read(&[before.clone(), junk, tlog(&sent[4..])].concat());
    assert_eq!(frames(&records), sent);
    assert_eq!(report.resyncs, [Resync { offset: before.len() as u64, skipped_bytes: 333 }]);
}

#[test]
fn junk_before_the_first_record() {
    let sent = attitudes(5);
    let (records, report) = read(&[vec![0xFE; 50], tlog(&sent)].concat());
    assert_eq!(frames(&records), sent);
    assert_eq!(report.skipped_bytes, 50);
}

#[test]
fn trailing_junk_does_not_lose_the_log() {
    let sent = attitudes(5);
    let (records, report) = read(&[tlog(&sent), vec![0xA5; 9]].concat());
    assert_eq!(frames(&records), sent);
    assert_eq!((report.skipped_bytes, report.truncated_tail_bytes), (9, 0));
}

#[test]
fn a_wrong_checksum_costs_its_frame_alone() {
    let mut sent = attitudes(5);
    sent[2][14] ^= 1;
    let (records, report) = read(&tlog(&sent));
    assert_eq!(records.len(), 4);
    assert_eq!((report.bad_crc, report.resync_count, report.lost_frames()), (1, 0, 1));
}

#[test]
fn a_wrong_length_is_left_behind_at_the_next_record() {
    for length in [3, 200, 255] {
        let mut sent = attitudes(8);
        sent[2][1] = length;
        let (records, report) = read(&tlog(&sent));
        assert_eq!(frames(&records), [&sent[..2], &sent[3..]].concat(), "length {length}");
        assert_eq!(report.resync_count, 1);
    }
}

#[test]
fn missing_bytes_cost_the_record_they_are_missing_from() {
    let sent = attitudes(8);
    let mut bytes = tlog(&sent);
    bytes.drain(150..160);
    let (records, _) = read(&bytes);
    assert!(records.len() >= 6, "{}", records.len());
}

#[test]
fn a_packet_inside_an_unknown_frame_stays_inside() {
    let fake = v2(header(1, 9), &heartbeat());
    let inside = record(START_US, &fake);
    let carrier = unknown(1, &[&[5; 3], &inside[..], &inside, &[1; 30]].concat());
    let sent = vec![v2(header(1, 0), &attitude(1)), carrier, v2(header(1, 2), &attitude(2))];
    assert_eq!(frames(&read(&tlog(&sent)).0), sent);
}

#[test]
fn lost_and_doubled_frames_are_counted_for_each_sender() {
    let mut sent = attitudes(20);
    sent.insert(3, sent[2].clone());
    sent.drain(10..14);
    let other: Vec<_> = (0..5).map(|index| v2(header(7, 250 + index), &heartbeat())).collect();
    let (_, report) = read(&tlog(&[sent, other].concat()));
    let sender = |system| report.senders.iter().find(|sender| sender.system == SystemId(system)).unwrap();
    assert_eq!((sender(1).lost, sender(1).duplicates, sender(1).component), (4, 1, ComponentId(1)));
    assert_eq!((sender(7).lost, sender(7).duplicates, sender(7).frames), (0, 0, 5));
    assert_eq!(sender(1).messages.get(30), 17);
    assert_eq!(sender(7).messages.iter().collect::<Vec<_>>(), [(0, 5)]);
}

#[test]
fn a_frame_that_comes_late_is_not_lost() {
    let mut sent = attitudes(20);
    sent.swap(8, 10);
    assert_eq!(read(&tlog(&sent)).1.lost_frames(), 0);
}

#[test]
fn an_empty_file_is_refused() {
    let refused = TlogReader::new(&[][..]).next_record().unwrap_err();
    assert!(matches!(refused, LogError::Empty));
    assert!(refused.to_string().contains("empty"));
}

#[test]
fn a_file_of_something_else_is_refused_without_reading_it_all() {
    let text = b"time,roll,pitch\n0.0,0.1,0.2\n".repeat(200_000);
    let mut reader = TlogReader::new(&text[..]);
    let refused = reader.next_record().unwrap_err();
    assert!(refused.to_string().starts_with("expected a telemetry log"), "{refused}");
    assert!(2 * reader.report().bytes < text.len() as u64);
}

#[test]
fn frames_without_stamps_are_told_from_a_log() {
    let refused = TlogReader::new(&attitudes(20).concat()[..]).next_record().unwrap_err();
    assert!(refused.to_string().contains("frames without stamps"), "{refused}");
}

#[test]
fn the_writers_stamps_are_even_and_never_run_back() {
    let sent = attitudes(4);
    let mut writer = TlogWriter::new(Vec::new());
    for (stamp, frame) in [START_US + 3, START_US + 9, START_US - 1, START_US + 100].into_iter().zip(&sent) {
        writer.write(stamp, support::frame(frame)).unwrap();
    }
    let (records, report) = read(&writer.into_inner());
    assert_eq!(records.iter().map(|record| record.0 - START_US).collect::<Vec<_>>(), [0, 8, 8, 100]);
    assert_eq!(report.backward_stamps, 0);
}

#[test]
fn the_writer_writes_a_record_at_once() {
    struct Counting(Vec<usize>);
    impl std::io::Write for Counting {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.push(bytes.len());
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let sent = attitudes(2);
    let mut writer = TlogWriter::new(Counting(Vec::new()));
    for frame in &sent {
        writer.write(START_US, support::frame(frame)).unwrap();
    }
    assert_eq!(writer.into_inner().0, [sent[0].len() + STAMP_BYTES, sent[1].len() + STAMP_BYTES]);
}

/// Gives bytes out in small pieces, as a pipe does.
struct Trickle<'a>(&'a [u8], usize);

impl std::io::Read for Trickle<'_> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        let piece = self.1.min(self.0.len()).min(into.len());
        into[..piece].copy_from_slice(&self.0[..piece]);
        self.0 = &self.0[piece..];
        Ok(piece)
    }
}

fn any_frame() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        (any::<u32>(), any::<u8>()).prop_map(|(time, sequence)| v2(header(1, sequence), &attitude(time))),
        (any::<u32>(), any::<u8>()).prop_map(|(time, sequence)| v1(header(1, sequence), &attitude(time))),
        any::<u8>().prop_map(|sequence| signed(sequence, &heartbeat())),
        (proptest::collection::vec(any::<u8>(), 0..255), any::<u8>())
            .prop_map(|(payload, sequence)| unknown(sequence, &payload)),
    ]
}

proptest! {
    #![proptest_config(support::cases())]

    #[test]
    fn what_the_writer_wrote_the_reader_reads(
        sent in proptest::collection::vec((0_u64..4_000_000, any_frame()), 1..60),
        piece in 1_usize..2000,
    ) {
        let mut writer = TlogWriter::new(Vec::new());
        let mut stamp_us = START_US;
        let mut written = Vec::new();
        for (later, frame) in &sent {
            stamp_us += later;
            written.push((writer.write(stamp_us, support::frame(frame)).unwrap(), frame.clone()));
        }
        let bytes = writer.into_inner();
        let mut reader = TlogReader::new(Trickle(&bytes, piece));
        let mut records = Vec::new();
        while let Some(record) = reader.next_record().unwrap() {
            records.push((record.stamp_us, record.frame.bytes().to_vec()));
        }
        prop_assert_eq!(records, written);
        prop_assert_eq!(reader.report().resync_count, 0);
    }

    #[test]
    fn arbitrary_bytes_do_no_harm(
        bytes in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD), Just(0xFE), Just(0)], 0..3000),
    ) {
        let mut reader = TlogReader::new(&bytes[..]);
        while let Ok(Some(_)) = reader.next_record() {}
    }

    #[test]
    fn noise_between_records_costs_no_frame_behind_it(
        noise in proptest::collection::vec(prop_oneof![any::<u8>(), Just(0xFD), Just(0xFE), Just(0)], 0..600),
        at in 0_usize..20,
    ) {
        let sent = attitudes(40);
        let whole: Vec<Vec<u8>> = (0_u64..).zip(&sent).map(|(i, frame)| record(START_US + i * 10_000, frame)).collect();
        let bytes = [whole[..at].concat(), noise, whole[at..].concat()].concat();
        let found: Vec<_> = frames(&read(&bytes).0).into_iter().filter(|frame| sent.contains(frame)).collect();
        prop_assert_eq!(found, sent);
    }

    #[test]
    fn a_damaged_log_is_accounted_for(
        place in 0_usize..2000, with in proptest::collection::vec(any::<u8>(), 1..50),
    ) {
        let mut bytes = tlog(&attitudes(40));
        for (to, from) in bytes.iter_mut().skip(place).zip(with) {
            *to = from;
        }
        let (records, report) = read(&bytes);
        prop_assert!(records.len() >= 36);
        prop_assert_eq!(report.bytes, bytes.len() as u64);
    }
}
