//! Writes telemetry logs.

use std::io::{self, Write};

use super::stamp::STAMP_BYTES;
use crate::wire::frame::{Frame, MAX_FRAME_BYTES};

/// Stamp bits that some ground stations use for the link's number; ours are zero.
const LINK_BITS: u64 = 0b11;

/// Writes frames with their host stamps. Stamps never go backwards, whatever the caller's clock does.
#[derive(Debug)]
pub struct TlogWriter<W: Write> {
    to: W,
    last_stamp_us: u64,
}

impl<W: Write> TlogWriter<W> {
    /// A log that begins at the current end of `to`.
    pub fn new(to: W) -> Self {
        Self { to, last_stamp_us: 0 }
    }

    /// Appends one frame, received or sent at `stamp_us` (microseconds since 1970 UTC), in a single
    /// write. Returns the stamp as written: its low two bits are zero and it is never before the last.
    ///
    /// # Errors
    /// What the writer beneath reports.
    pub fn write(&mut self, stamp_us: u64, frame: Frame<'_>) -> io::Result<u64> {
        let stamp_us = (stamp_us & !LINK_BITS).max(self.last_stamp_us);
        let mut record = [0_u8; STAMP_BYTES + MAX_FRAME_BYTES];
        let bytes = STAMP_BYTES + frame.bytes().len();
        record[..STAMP_BYTES].copy_from_slice(&stamp_us.to_be_bytes());
        record[STAMP_BYTES..bytes].copy_from_slice(frame.bytes());
        self.to.write_all(&record[..bytes])?;
        self.last_stamp_us = stamp_us;
        Ok(stamp_us)
    }

    /// Hands buffered records on: call it each second and at every arming and mode change, so that a
    /// power loss costs no more.
    ///
    /// # Errors
    /// What the writer beneath reports.
    pub fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }

    /// The writer beneath: what is written past this one is no record.
    pub fn get_mut(&mut self) -> &mut W {
        &mut self.to
    }

    /// The writer beneath.
    pub fn into_inner(self) -> W {
        self.to
    }
}
