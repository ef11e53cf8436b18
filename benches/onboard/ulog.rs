//! PX4's logs: read message by message, and made long.

use std::error::Error;
use std::path::Path;

use mavid::log::ulog::{Message, UlogReader};

use super::{FILE_BYTES, PAUSE_US, stamp_of};

/// Length and letter of a message, and the number of its topic.
const BEFORE_FIELDS: usize = 5;

/// Reads all messages.
pub fn walk(log: &Path) -> Result<(), Box<dyn Error>> {
    let mut reader = UlogReader::new(std::fs::File::open(log)?);
    while reader.next_message()?.is_some() {}
    Ok(())
}

/// The log's messages again and again, each round after the one before it.
pub fn repeated(log: &[u8]) -> Vec<u8> {
    let mut reader = UlogReader::new(log);
    // of topics: bytes of each message, and where its stamps are
    let mut messages: Vec<(&[u8], Vec<usize>)> = Vec::new();
    let mut long = Vec::with_capacity(FILE_BYTES);
    let (mut first_us, mut last_us) = (u64::MAX, 0);
    while let Ok(Some(entry)) = reader.next_message() {
        let Ok(at) = usize::try_from(entry.offset) else { break };
        let bytes = &log[at..at + entry.bytes];
        let Message::Data { subscription, .. } = entry.message else {
            // definitions and parameters stand once
            long.extend_from_slice(bytes);
            continue;
        };
        let stamps =
            ["timestamp", "timestamp_sample"].iter().filter_map(|path| subscription.layout.cell(path));
        let stamps: Vec<usize> = stamps.map(|cell| BEFORE_FIELDS + cell.offset).collect();
        for stamp in &stamps {
            let us = stamp_of(bytes, *stamp);
            (first_us, last_us) = (first_us.min(us), last_us.max(us));
        }
        messages.push((bytes, stamps));
    }
    let span_us = last_us.saturating_sub(first_us) + PAUSE_US;
    let mut round = 0;
    while long.len() < FILE_BYTES && !messages.is_empty() {
        for (bytes, stamps) in &messages {
            let start = long.len();
            long.extend_from_slice(bytes);
            for stamp in stamps {
                let us = stamp_of(bytes, *stamp) + round * span_us;
                long[start + stamp..start + stamp + 8].copy_from_slice(&us.to_le_bytes());
            }
        }
        round += 1;
    }
    long
}
