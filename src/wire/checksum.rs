//! MAVLink's checksum (CRC-16/MCRF4XX) and the seed that each known message adds to it.

use crc::{CRC_16_MCRF4XX, Crc, Table};
use mavlink::Message;
use mavlink::dialects::ardupilotmega::MavMessage;

/// Sixteen bytes at a time.
static CRC: Crc<u16, Table<16>> = Crc::<u16, Table<16>>::new(&CRC_16_MCRF4XX);

/// Checksum of `bytes` (a frame without its marker, up to the end of the payload) and of the message's
/// seed after it.
#[must_use]
pub fn checksum(bytes: &[u8], seed: u8) -> u16 {
    let mut digest = CRC.digest();
    digest.update(bytes);
    digest.update(&[seed]);
    digest.finalize()
}

/// Every id of the dialect lies below this.
const DENSE_IDS: usize = 1 << 16;

/// Which message ids are known, and their seeds.
///
/// The dialect's own `extra_crc` answers 0 for an id that it does not know, so that every unknown frame
/// would fail its check; known ids are those that the dialect lists.
#[derive(Debug, Clone)]
pub struct CrcSeeds {
    dense: Box<[Option<u8>]>,
}

impl CrcSeeds {
    /// The seeds of the `ardupilotmega` dialect, which contains `common`.
    #[must_use]
    pub fn new() -> Self {
        let mut dense = vec![None; DENSE_IDS].into_boxed_slice();
        for id in MavMessage::all_ids() {
            if let Some(seed) = usize::try_from(*id).ok().and_then(|index| dense.get_mut(index)) {
                *seed = Some(MavMessage::extra_crc(*id));
            }
        }
        Self { dense }
    }

    /// The seed of a message, `None` where the dialect does not know it.
    #[must_use]
    pub fn get(&self, message_id: u32) -> Option<u8> {
        let index = usize::try_from(message_id).ok()?;
        match self.dense.get(index) {
            Some(seed) => *seed,
            None => MavMessage::all_ids().contains(&message_id).then(|| MavMessage::extra_crc(message_id)),
        }
    }
}

impl Default for CrcSeeds {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn check_value_of_the_catalogue() {
        // CRC-16/MCRF4XX of "123456789" is 0x6F91; the last byte goes in as the seed
        assert_eq!(checksum(b"12345678", b'9'), 0x6F91);
    }

    #[test]
    fn unknown_ids_have_no_seed() {
        let seeds = CrcSeeds::new();
        assert_eq!(seeds.get(0), Some(50));
        assert_eq!(seeds.get(291), Some(10));
        assert_eq!(seeds.get(60_001), None);
        assert_eq!(seeds.get(0xFF_FFFF), None);
    }

    #[test]
    fn known_ids_are_those_that_the_dialect_has_a_message_of() {
        let seeds = CrcSeeds::new();
        for id in (0..1 << 16).chain([0x01_0000, 0xFF_FFFF]) {
            let seed = MavMessage::default_message_from_id(id).map(|_| MavMessage::extra_crc(id));
            assert_eq!(seeds.get(id), seed, "{id}");
        }
    }

    proptest! {
        #[test]
        fn agrees_with_the_mavlink_crate(bytes in proptest::collection::vec(any::<u8>(), 0..300), seed: u8) {
            prop_assert_eq!(checksum(&bytes, seed), mavlink::calculate_crc(&bytes, seed));
        }
    }
}
