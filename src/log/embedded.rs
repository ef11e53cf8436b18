//! How the embedded simulated vehicle says what it is.

/// `uid2` of its AUTOPILOT_VERSION. The autopilots fill this field with the serial number of a processor,
/// which is binary; a sentence of 18 letters cannot be one by accident.
pub const EMBEDDED_UID2: [u8; 18] = *b"mavid simulated v1";
