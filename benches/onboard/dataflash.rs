//! ArduPilot's logs: read message by message, and made long.

use std::error::Error;
use std::path::Path;

use mavid::log::DataflashReader;

use super::{FILE_BYTES, PAUSE_US, stamp_of};

/// Reads all messages.
pub fn walk(log: &Path) -> Result<(), Box<dyn Error>> {
    let mut reader = DataflashReader::new(std::fs::File::open(log)?);
    while reader.next_message()?.is_some() {}
    Ok(())
}

/// The log's messages again and again, each round after the one before it.
pub fn repeated(log: &[u8]) -> Vec<u8> {
    let mut reader = DataflashReader::new(log);
    // bytes of each message, and where its stamps are
    let mut messages: Vec<(Vec<u8>, Vec<usize>)> = Vec::new();
    let mut last_us = 0;
    let mut first_us = u64::MAX;
    while let Ok(Some(message)) = reader.next_message() {
        let Ok(at) = usize::try_from(message.offset) else { break };
        let fields = message.definition.fields.iter();
        let stamps: Vec<usize> = fields
            .filter(|field| ["TimeUS", "SampleUS"].contains(&field.name.as_str()))
            .map(|field| field.offset)
            .collect();
        let bytes = log[at..at + message.definition.bytes].to_vec();
        for stamp in &stamps {
            let us = stamp_of(&bytes, *stamp);
            (first_us, last_us) = (first_us.min(us), last_us.max(us));
        }
        messages.push((bytes, stamps));
    }
    let span_us = last_us.saturating_sub(first_us) + PAUSE_US;
    let mut long = Vec::with_capacity(FILE_BYTES);
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
        // definitions and parameters stand once
        messages.retain(|(bytes, stamps)| !stamps.is_empty() && bytes[2] != 128);
        round += 1;
    }
    long
}
