//! Telemetry logs of messages that nobody sent: simulated flights.

use std::io::{self, Write};

use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};

use super::stamp::STAMP_BYTES;
use super::writer::TlogWriter;
use crate::wire::frame::Frame;

/// Writes messages of one sender (system 1, component 1) as MAVLink 2 frames, numbered as that sender would.
#[derive(Debug)]
pub struct MessageWriter<W: Write> {
    log: TlogWriter<W>,
    sequence: u8,
}

impl<W: Write> MessageWriter<W> {
    /// A log that begins at the current end of `to`.
    pub fn new(to: W) -> Self {
        Self { log: TlogWriter::new(to), sequence: 0 }
    }

    /// Appends a message, received at `stamp_us` (microseconds since 1970 UTC; see [`TlogWriter::write`]). Returns
    /// the number of bytes.
    ///
    /// # Errors
    /// What the writer beneath reports.
    pub fn write(&mut self, stamp_us: u64, message: &MavMessage) -> io::Result<usize> {
        let header = MavHeader { system_id: 1, component_id: 1, sequence: self.sequence };
        self.lose();
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(header, message);
        let frame = Frame::at_start(raw.raw_bytes())
            .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "a serialised message is no frame"))?;
        self.log.write(stamp_us, frame)?;
        Ok(STAMP_BYTES + frame.bytes().len())
    }

    /// A message that was sent and never arrived: its number is missing.
    pub fn lose(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
    }

    /// Hands buffered bytes on and gives the writer beneath.
    ///
    /// # Errors
    /// What the writer beneath reports.
    pub fn finish(mut self) -> io::Result<W> {
        self.log.flush()?;
        Ok(self.log.into_inner())
    }
}
