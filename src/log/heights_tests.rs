//! A log format as a newcomer would add it, compiled for the tests: CONTRIBUTING.md points here.
//!
//! Heights: a record of 16 bytes with the signature, then one a sample: s and m above the start, little-endian.

use std::io::{BufReader, Read};

use super::error::LogError;
use super::format::{Certainty, Format, Place, Sink};
use super::input::Input;
use super::loss::Loss;
use super::options::OpenOptions;
use super::report::ReadReport;
use crate::recording::{Event, Quantity, StreamKey};

const SIGNATURE: &[u8] = b"HEIGHTS 1.0\0\0\0\0\0";
const RECORD_BYTES: u64 = 16;

/// Heights.
pub(super) const FORMAT: Format = Format {
    name: "list of heights (.heights)",
    ending: "heights",
    takes_system: false,
    takes_columns: false,
    sniff,
    read,
    read_whole: None,
};

fn sniff(head: &[u8]) -> Option<Certainty> {
    head.starts_with(SIGNATURE).then_some(Certainty::Certain)
}

fn read(input: &Input<'_>, _: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let stream = StreamKey { quantity: Quantity::Position, source: "HEIGHTS", instance: 0 };
    let mut report = ReadReport { format: FORMAT.name, ..ReadReport::default() };
    let mut from = BufReader::new(input.open()?);
    let (mut record, mut offset) = (Vec::new(), 0);
    loop {
        record.clear();
        let taken = from.by_ref().take(RECORD_BYTES).read_to_end(&mut record);
        let bytes = taken.map_err(|source| LogError::Read { offset, source })? as u64;
        match record.as_slice().as_chunks::<8>() {
            (&[time, height], _) if offset > 0 => {
                let (time_s, height_m) = (f64::from_le_bytes(time), f64::from_le_bytes(height));
                let place = Place { offset, arrival_us: None };
                sink(place, Event::Sample { stream, time_s, values: &[0.0, 0.0, height_m] });
            }
            (&[_, _], _) => {}
            _ => {
                let lost = Loss::CutOff { bytes, first_byte: offset };
                report.losses.extend((bytes > 0).then_some(lost));
                return Ok(report);
            }
        }
        offset += bytes;
    }
}

fn file(samples: u32) -> Vec<u8> {
    let mut bytes = SIGNATURE.to_vec();
    for at in (0..samples).map(f64::from) {
        bytes.extend([0.1 * at, at].into_iter().flat_map(f64::to_le_bytes));
    }
    bytes
}

#[test]
fn cut_anywhere_each_byte_is_in_a_sample_or_in_a_loss() {
    let whole = file(5);
    assert_eq!((FORMAT.sniff)(&whole), Some(Certainty::Certain));
    for end in SIGNATURE.len()..=whole.len() {
        let mut heights = Vec::new();
        let mut sink = |_: Place, event: Event<'_>| match event {
            Event::Sample { values, .. } => heights.push(values[2]),
            other => panic!("{other:?}"),
        };
        let input = Input::Bytes { name: "bytes", bytes: &whole[..end] };
        let report = (FORMAT.read)(&input, &OpenOptions::default(), &mut sink).unwrap();
        let samples = (end - SIGNATURE.len()) / 16;
        assert_eq!(heights, [0.0, 1.0, 2.0, 3.0, 4.0][..samples]);
        let (bytes, first_byte) = ((end % 16) as u64, (end - end % 16) as u64);
        let lost = (bytes > 0).then_some(Loss::CutOff { bytes, first_byte });
        assert_eq!(report.losses, Vec::from_iter(lost));
    }
}
