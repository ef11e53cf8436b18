//! How the embedded simulated vehicle says what it is, and how a program knows the one that it started itself.

use std::hash::{BuildHasher, RandomState};

use super::frame::Payload;

/// `uid2` of AUTOPILOT_VERSION of an embedded vehicle that runs on its own. The autopilots fill this field with the
/// serial number of a processor, which is binary; a sentence of 18 letters cannot be one by accident. Anybody can send
/// it: it is for people who read a log, and permits nothing.
pub const EMBEDDED_UID2: [u8; UID2_BYTES] = *b"mavid simulated v1";

/// Length of the field, and where it begins in the payload of AUTOPILOT_VERSION.
pub const UID2_BYTES: usize = 18;
const UID2_OFFSET: usize = 60;

/// A secret of one process: it gives it to the vehicle that it starts, and knows the vehicle by it. What comes over a
/// link from anybody else cannot have it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Nonce([u8; UID2_BYTES]);

impl Nonce {
    /// A new one, drawn from the randomness that the system gives every process for its hash tables.
    #[must_use]
    pub fn random() -> Self {
        let mut bytes = [0; UID2_BYTES];
        for chunk in bytes.chunks_mut(8) {
            let drawn = RandomState::new().hash_one(0_u8).to_le_bytes();
            chunk.copy_from_slice(&drawn[..chunk.len()]);
        }
        Self(bytes)
    }

    /// As `uid2` of AUTOPILOT_VERSION.
    #[must_use]
    pub fn uid2(&self) -> [u8; UID2_BYTES] {
        self.0
    }

    /// Whether an AUTOPILOT_VERSION carries it.
    #[must_use]
    pub fn is_in(&self, version: Payload<'_>) -> bool {
        self.0.iter().enumerate().all(|(at, byte)| version.u8(UID2_OFFSET + at) == *byte)
    }
}

impl std::fmt::Debug for Nonce {
    /// Without the secret: settings are printed and recorded.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Nonce")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_are_alike_and_none_is_what_everybody_knows() {
        let drawn: Vec<Nonce> = (0..100).map(|_| Nonce::random()).collect();
        for (index, nonce) in drawn.iter().enumerate() {
            assert!(!drawn[..index].contains(nonce));
            assert!(nonce.uid2() != EMBEDDED_UID2 && nonce.uid2() != [0; UID2_BYTES]);
            assert_eq!(format!("{nonce:?}"), "Nonce");
        }
    }
}
