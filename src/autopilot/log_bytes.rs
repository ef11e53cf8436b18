//! Bytes by which the autopilots' own logs are known and cut into messages.

/// First bytes of a ULog file; a version and a stamp follow (PX4's user guide, "ULog File Format").
pub const ULOG_MAGIC: [u8; 7] = *b"ULog\x01\x12\x35";
/// Bytes of the head of a ULog file.
pub const ULOG_HEAD_BYTES: usize = 16;
/// Bytes of the ULog message with the flags of a file.
pub const ULOG_FLAG_BYTES: usize = 40;
/// Depth of nested types in a ULog beyond which a definition is none: PX4's have two levels, and a definition may name itself.
pub const ULOG_DEEPEST: usize = 8;
/// First bytes of every message of a DataFlash log (ArduPilot's `AP_Logger`).
pub const DATAFLASH_MARKER: [u8; 2] = [0xa3, 0x95];
