//! One frame of a log with its host stamp.

use crate::wire::frame::Frame;

/// One frame of a log with its host stamp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record<'a> {
    /// host's time of reception, microseconds since 1970 UTC as written, low two bits included
    pub stamp_us: u64,
    /// byte offset of the frame in the file
    pub offset: u64,
    /// the dialect knows the message, and its checksum is right
    pub known: bool,
    /// the frame, byte for byte
    pub frame: Frame<'a>,
}
