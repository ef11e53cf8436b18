//! The host stamp of a record.

/// Bytes of a host stamp.
pub const STAMP_BYTES: usize = 8;

/// 2010-01-01 UTC: no telemetry log is older.
const EARLIEST_US: u64 = 1_262_304_000_000_000;
/// 2100-01-01 UTC.
const LATEST_US: u64 = 4_102_444_800_000_000;

/// Order of a stamp's bytes. Files in the wild are big-endian; some old writers' are not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ByteOrder {
    /// as the format says
    #[default]
    Big,
    /// as some old writers did
    Little,
}

impl ByteOrder {
    /// The stamp that `bytes` begin with, microseconds since 1970 UTC; `None` where there are too few.
    #[must_use]
    pub fn stamp_us(self, bytes: &[u8]) -> Option<u64> {
        let bytes = *bytes.first_chunk::<STAMP_BYTES>()?;
        Some(match self {
            Self::Big => u64::from_be_bytes(bytes),
            Self::Little => u64::from_le_bytes(bytes),
        })
    }
}

/// A stamp that may be the host's wall clock: between 2010 and 2100.
#[must_use]
pub fn is_wall_clock(stamp_us: u64) -> bool {
    (EARLIEST_US..LATEST_US).contains(&stamp_us)
}
