//! What a file is that no format reads, so that its owner is told what to do with it.

use crate::wire::{Check, CrcSeeds, Frame};

/// A kind of file that is not read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foreign {
    /// its first bytes
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

/// Kinds of files by their first bytes.
const KNOWN: &[Foreign] = &[
    Foreign {
        signature: b"\xa3\x95\x80\x80\x59FMT",
        what: "the first bytes of an ArduPilot log (.bin)",
        advice: "give the whole log",
    },
    Foreign {
        signature: b"\xa3\x95\x80",
        what: "a PX4 log of the format before ULog (sdlog2, .px4log)",
        advice: SDLOG2,
    },
    Foreign {
        signature: b"\xa3\x95",
        what: "a piece of an ArduPilot log (.bin) without the definitions that begin it",
        advice: "give the whole log",
    },
    Foreign { signature: b"\x1f\x8b", what: "a gzip archive", advice: UNPACK },
    Foreign { signature: b"PK\x03\x04", what: "a zip archive", advice: UNPACK },
    Foreign { signature: b"\xfd7zXZ\0", what: "an xz archive", advice: UNPACK },
    Foreign { signature: b"\x28\xb5\x2f\xfd", what: "a zstd archive", advice: UNPACK },
    Foreign { signature: b"BZh", what: "a bzip2 archive", advice: UNPACK },
    Foreign { signature: b"7z\xbc\xaf\x27\x1c", what: "a 7z archive", advice: UNPACK },
    Foreign { signature: b"#ROSBAG", what: "a ROS bag", advice: TABLE },
    Foreign { signature: b"\x89MCAP", what: "an MCAP file", advice: TABLE },
    Foreign { signature: b"SQLite format 3\0", what: "an SQLite database (a ROS 2 bag?)", advice: TABLE },
    Foreign { signature: b"\x89HDF", what: "an HDF5 file", advice: TABLE },
    Foreign { signature: b"MATLAB 5.0", what: "a MATLAB file", advice: TABLE },
    Foreign { signature: b"{", what: "JSON", advice: TABLE },
    Foreign { signature: b"<", what: "XML or HTML", advice: "download the log itself" },
    Foreign { signature: b"\xff\xfe", what: "text in UTF-16", advice: "save it as UTF-8" },
    Foreign { signature: b"\xfe\xff", what: "text in UTF-16", advice: "save it as UTF-8" },
];

/// Bytes that are told of what nobody knows.
const TOLD_BYTES: usize = 8;

/// The kind of file that begins with these bytes, if its signature is known.
pub(super) fn foreign(head: &[u8]) -> Option<&'static Foreign> {
    KNOWN.iter().find(|kind| head.starts_with(kind.signature))
}

/// What a file of no known signature is, by its first bytes, and what to do with it.
pub(super) fn otherwise(head: &[u8]) -> (String, &'static str) {
    let is_frame =
        |head| Frame::at_start(head).is_some_and(|frame| frame.check(&CrcSeeds::new()) == Check::Right);
    let is_binary = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    if head.is_empty() {
        ("an empty file".to_owned(), "nothing was recorded into it")
    } else if head.iter().all(|byte| *byte == 0) {
        (
            "a file that begins with zeros only".to_owned(),
            "its recording was interrupted before anything was stored",
        )
    } else if is_frame(head) {
        ("MAVLink frames without stamps".to_owned(), "record the link with `mavid record`")
    } else if head.iter().any(is_binary) {
        let first: Vec<String> = head.iter().take(TOLD_BYTES).map(|byte| format!("{byte:02x}")).collect();
        (format!("binary data that begins with {}", first.join(" ")), "give the log itself")
    } else {
        (
            "text without a header of columns".to_owned(),
            "the first line of a table names its columns, as configs/csv/default.toml lists them",
        )
    }
}
