//! The signature of a frame.

use sha2::{Digest, Sha256};

use super::key::SigningKey;

/// Link id, time, signature.
pub(crate) const TAIL_BYTES: usize = 13;
pub(super) const SIGNATURE_BYTES: usize = 6;

impl SigningKey {
    pub(super) fn signature(&self, signed: &[u8]) -> [u8; SIGNATURE_BYTES] {
        let digest = Sha256::new().chain_update(self.bytes()).chain_update(signed).finalize();
        std::array::from_fn(|index| digest[index])
    }
}

/// How long it takes does not tell how much is right.
pub(super) fn equal_in_constant_time(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && std::hint::black_box(a.iter().zip(b).fold(0, |differ, (a, b)| differ | a ^ b)) == 0
}
