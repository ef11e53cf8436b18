//! What a file is that no format reads, so that its owner is told what to do with it.

use crate::autopilot::ULOG_MAGIC;
use crate::wire::{Check, CrcSeeds, Frame};

/// A kind of file that is not read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foreign {
    /// where its signature stands
    at: usize,
    /// bytes that tell it
    signature: &'static [u8],
    /// in words
    pub what: &'static str,
    /// what to do with it
    pub advice: &'static str,
}

const UNPACK: &str = "unpack it first";
const SDLOG2: &str =
    "export it as a table of comma-separated values, with sdlog2_dump.py of PX4's releases until 1.6";
const TABLE: &str = "export it as a table of comma-separated values";
const BAG: &str =
    "export its topics as one table of comma-separated values, or give the log of the autopilot";
const BLACKBOX: &str =
    "export it as a table of comma-separated values with blackbox_decode, and give --csv-map";
const PAGE: &str = "download the log itself: a page of the site came in its place";
const NO_LOG: &str = "give the log itself";

const fn begins(signature: &'static [u8], what: &'static str, advice: &'static str) -> Foreign {
    Foreign { at: 0, signature, what, advice }
}

/// Kinds of files by their first bytes.
const KNOWN: &[Foreign] = &[
    begins(b"\xa3\x95\x80\x80\x59FMT", "the first bytes of an ArduPilot log (.bin)", "give the whole log"),
    begins(b"ULog\x01", "the first bytes of a PX4 log (.ulg)", "give the whole log"),
    begins(b"\xa3\x95\x80", "a PX4 log of the format before ULog (sdlog2, .px4log)", SDLOG2),
    begins(
        b"\xa3\x95",
        "a piece of an ArduPilot log (.bin) without the definitions that begin it",
        "give the whole log",
    ),
    begins(b"\x1f\x8b", "a gzip archive", UNPACK),
    begins(b"PK\x03\x04", "a zip archive", UNPACK),
    begins(b"PK\x05\x06", "an empty zip archive", "pack the log again: nothing is in it"),
    begins(b"\xfd7zXZ\0", "an xz archive", UNPACK),
    begins(b"\x28\xb5\x2f\xfd", "a zstd archive", UNPACK),
    begins(b"BZh", "a bzip2 archive", UNPACK),
    begins(b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    begins(b"Rar!\x1a\x07", "a rar archive", UNPACK),
    Foreign { at: 257, signature: b"ustar", what: "a tar archive", advice: UNPACK },
    begins(b"#ROSBAG", "a ROS bag", BAG),
    begins(b"SQLite format 3\0", "an SQLite database (a ROS 2 bag?)", BAG),
    begins(b"\x89MCAP", "an MCAP file (a ROS 2 bag?)", BAG),
    begins(b"H Product:Blackbox", "a blackbox log of Betaflight or INAV", BLACKBOX),
    begins(b"\x89HDF", "an HDF5 file", TABLE),
    begins(b"MATLAB 5.0", "a MATLAB file", TABLE),
    begins(b"PAR1", "a Parquet file", TABLE),
    begins(b"{", "JSON", TABLE),
    begins(b"<?xml", "XML", NO_LOG),
    begins(b"<", "a web page (HTML)", PAGE),
    begins(
        b"version https://git-lfs.github.com",
        "the pointer to a file in Git LFS",
        "fetch the file itself: git lfs pull",
    ),
    begins(b"# Onboard parameters", PARAMETERS.what, PARAMETERS.advice),
    begins(b"\x89PNG", "an image (PNG)", NO_LOG),
    begins(b"\xff\xd8\xff", "an image (JPEG)", NO_LOG),
    begins(b"%PDF", "a PDF document", NO_LOG),
    begins(b"\xff\xfe", "text in UTF-16", "save it as UTF-8"),
    begins(b"\xfe\xff", "text in UTF-16", "save it as UTF-8"),
];

/// Fewer bytes of a file than tell ArduPilot's log from PX4's of before ULog.
const BEGUN: Foreign = begins(
    b"\xa3\x95",
    "the first bytes of an ArduPilot log (.bin), or of a PX4 log of the format before ULog",
    "give the whole log",
);
/// Marker, number, number and length of what is defined, and its name but for a letter.
const BEGUN_BYTES: usize = 8;

/// The same of PX4's log, whose first bytes are longer than what is told of it.
const BEGINNINGS: &[(&[u8], Foreign)] =
    &[(&ULOG_MAGIC, begins(b"UL", "the first bytes of a PX4 log (.ulg)", "give the whole log"))];

/// Bytes that are told of what nobody knows.
const TOLD_BYTES: usize = 8;

/// An autopilot's parameters, as ground stations save them. Those of ArduPilot have no signature.
const PARAMETERS: Foreign = begins(b"", "a file of parameters", "give the log of a flight");

/// Lines by which a file of parameters is told.
const LEAST_PARAMETERS: usize = 2;

/// Lines of a name in capitals and a number: ArduPilot's.
fn is_parameters(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    let is_comment = |line: &&str| line.is_empty() || line.starts_with('#');
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !is_comment(line)).collect();
    // the head's end may cut the last
    let all = if text.ends_with('\n') { Some(&lines[..]) } else { None };
    let whole = all.or_else(|| lines.split_last().map(|(_, whole)| whole)).unwrap_or_default();
    whole.len() >= LEAST_PARAMETERS && whole.iter().all(|line| is_parameter(line))
}

fn is_parameter(line: &str) -> bool {
    let separates = |letter: char| letter == ',' || letter.is_whitespace();
    let mut cells = line.split(separates).filter(|cell| !cell.is_empty());
    let is_name = |name: &str| {
        name.starts_with(|letter: char| letter.is_ascii_uppercase())
            && name.contains('_')
            && name
                .chars()
                .all(|letter| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_')
    };
    cells.next().is_some_and(is_name)
        && cells.next().is_some_and(|value| value.parse::<f64>().is_ok())
        && cells.next().is_none()
}

/// A vehicle file or a model of this program, which has no signature.
const VEHICLE: Foreign = begins(
    b"",
    "a vehicle file or a model",
    "give the log of a flight, and this file behind --vehicle; `mavid vehicle FILE` says what is in it",
);

/// Tables that every vehicle file has.
const VEHICLE_TABLES: [&str; 2] = ["[body]", "[propulsion]"];

fn is_vehicle_file(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    VEHICLE_TABLES.iter().all(|table| text.lines().any(|line| line.trim_start().starts_with(table)))
}

/// The kind of file that begins with these bytes, if its signature is known.
pub(super) fn foreign(head: &[u8]) -> Option<&'static Foreign> {
    if head.len() < BEGUN_BYTES && head.starts_with(BEGUN.signature) {
        return Some(&BEGUN);
    }
    let plain = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let is = |kind: &&Foreign| {
        let bytes = if kind.signature.is_ascii() && kind.at == 0 { plain } else { head };
        bytes.get(kind.at..).is_some_and(|bytes| bytes.starts_with(kind.signature))
    };
    if let Some(cut) = BEGINNINGS
        .iter()
        .find(|(magic, _)| head.len() < magic.len() && head.len() > 1 && magic.starts_with(head))
    {
        return Some(&cut.1);
    }
    // a letter alone begins binary data as well
    let is = |kind: &&Foreign| is(kind) && (kind.signature.len() > 1 || is_plain_text(head));
    let by_lines = || is_parameters(head).then_some(&PARAMETERS);
    KNOWN.iter().find(is).or_else(|| is_vehicle_file(head).then_some(&VEHICLE)).or_else(by_lines)
}

/// The kind of archive that begins with these bytes.
pub(super) fn archive(head: &[u8]) -> Option<&'static Foreign> {
    let is = |kind: &&Foreign| {
        kind.advice == UNPACK && head.get(kind.at..).is_some_and(|bytes| bytes.starts_with(kind.signature))
    };
    KNOWN.iter().find(is)
}

/// What a file of no known signature is, by its first bytes, and what to do with it.
pub(super) fn otherwise(head: &[u8]) -> (String, &'static str) {
    let is_frame =
        |head| Frame::at_start(head).is_some_and(|frame| frame.check(&CrcSeeds::new()) == Check::Right);
    if head.is_empty() {
        ("an empty file".to_owned(), "nothing was recorded into it")
    } else if head.iter().all(|byte| *byte == 0) {
        (
            "a file that begins with zeros only".to_owned(),
            "its recording was interrupted before anything was stored",
        )
    } else if is_begun_tlog(head) {
        ("the first bytes of a telemetry log (.tlog)".to_owned(), "give the whole log")
    } else if let Some(at) = head.windows(ULOG_MAGIC.len()).position(|bytes| bytes == ULOG_MAGIC) {
        (
            format!("{at} bytes of something else before a PX4 log (.ulg)"),
            "give the log without what stands before it",
        )
    } else if is_piece_of_dataflash(head) {
        (
            "a piece of an ArduPilot log (.bin) without the definitions that begin it".to_owned(),
            "give the whole log",
        )
    } else if is_piece_of_ulog(head) {
        (
            "a piece of a PX4 log (.ulg): its beginning is missing, and with it what its messages mean, so that nothing of \
             it can be read"
                .to_owned(),
            "give the whole log, as it lies on the vehicle's card",
        )
    } else if is_frame(head) {
        ("MAVLink frames without stamps".to_owned(), "record the link with `mavid record`")
    } else if !is_plain_text(head) {
        let first: Vec<String> = head.iter().take(TOLD_BYTES).map(|byte| format!("{byte:02x}")).collect();
        (format!("binary data that begins with {}", first.join(" ")), "give the log itself")
    } else {
        (
            "text that is no log and has no header of columns".to_owned(),
            "the first line of a table names its columns, as configs/csv/default.toml lists them",
        )
    }
}

/// Headers of messages by which a piece of an ArduPilot log is told that begins within one, and bytes to each at most.
const LEAST_HEADERS: usize = 8;
const HEADER_EVERY: usize = 256;

fn is_piece_of_dataflash(head: &[u8]) -> bool {
    let headers = head.windows(2).filter(|pair| *pair == b"\xa3\x95").count();
    headers >= LEAST_HEADERS && headers * HEADER_EVERY > head.len()
}

/// Kinds of a ULog's messages, and messages in a row by which a piece of one is told.
const ULOG_KINDS: &[u8] = b"BFIMPQAROLCSD";
/// See [`ULOG_KINDS`].
const LEAST_IN_A_ROW: usize = 12;
/// Bytes of a ULog's message that say its length and kind.
const ULOG_PREFIX: usize = 3;

fn is_piece_of_ulog(head: &[u8]) -> bool {
    let length = |at: usize| {
        let [low, high, kind] = head.get(at..at + ULOG_PREFIX)? else { return None };
        let bytes = usize::from(u16::from_le_bytes([*low, *high]));
        (bytes > 0 && ULOG_KINDS.contains(kind)).then_some(at + ULOG_PREFIX + bytes)
    };
    let in_a_row = |at: usize| {
        let mut next = at;
        (0..LEAST_IN_A_ROW).all(|_| length(next).inspect(|after| next = *after).is_some())
    };
    (0..head.len()).any(in_a_row)
}

/// Stamps of a telemetry log: microseconds since 1970 in these years begin so.
const STAMPS: [&[u8]; 3] = [&[0, 4], &[0, 5], &[0, 6]];
/// Bytes of a stamp.
const STAMP_BYTES: usize = 8;
/// Bytes of the longest record: shorter files may end within their first.
const LONGEST_RECORD: usize = STAMP_BYTES + 280 + 13;

/// A stamp, or the beginning of one, and no whole frame behind it.
fn is_begun_tlog(head: &[u8]) -> bool {
    let begins = STAMPS.iter().any(|stamp| head.starts_with(stamp));
    let is_frame = head.get(STAMP_BYTES).is_none_or(|marker| matches!(marker, 0xfd | 0xfe));
    begins && is_frame && head.len() < LONGEST_RECORD
}

/// Text without signs that steer something.
fn is_plain_text(head: &[u8]) -> bool {
    let is_binary = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    is_text(head) && !head.iter().any(is_binary)
}

/// UTF-8, but for a letter that the head's end cuts.
fn is_text(head: &[u8]) -> bool {
    std::str::from_utf8(head).map_or_else(|error| error.error_len().is_none(), |_| true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_within_its_first_bytes_is_told_as_that() {
        let by_signature = |head: &[u8]| foreign(head).map(|kind| kind.what);
        assert_eq!(by_signature(b"ULo"), Some("the first bytes of a PX4 log (.ulg)"));
        let (cut, _) = otherwise(&[0, 6, 0x5e, 1, 2, 3, 4, 5, 0xfd, 9, 0]);
        assert_eq!(cut, "the first bytes of a telemetry log (.tlog)");
        assert_eq!(otherwise(&[0, 6, 0x5e, 1, 2]).0, cut);
        let behind = [&[0_u8; 64][..], &ULOG_MAGIC, &[1; 100]].concat();
        assert_eq!(otherwise(&behind).0, "64 bytes of something else before a PX4 log (.ulg)");
    }

    #[test]
    fn one_letter_before_binary_data_is_neither_a_page_nor_json() {
        for letter in [b'<', b'{'] {
            assert!(foreign(&[letter, 0x80, 0x01, 0xff, 0x00]).is_none());
        }
        assert_eq!(foreign(b"<html>").map(|kind| kind.what), Some("a web page (HTML)"));
        assert_eq!(foreign(b"{\"a\": 1}").map(|kind| kind.what), Some("JSON"));
    }

    #[test]
    fn two_lines_of_parameters_are_enough() {
        let what = |text: &str| foreign(text.as_bytes()).map(|kind| kind.what);
        assert_eq!(what("ACRO_YAW_P,4.5\nFRAME_CLASS,1\n"), Some(PARAMETERS.what));
        assert_eq!(what("time_s,rotor_1\n0.1,0.5\n"), None);
    }
}
