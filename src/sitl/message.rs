//! A message on its way to the wire: payload in wire order, then the frame around it.

use mavlink::{MavlinkVersion, MessageData};

use crate::link::{Signing, TAIL_BYTES};
use crate::wire::{MARKER_V2, checksum};

/// One message as its payload, without the zeros at its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    id: u32,
    seed: u8,
    payload: Vec<u8>,
}

impl<D: MessageData> From<D> for Message {
    fn from(data: D) -> Self {
        let mut payload = vec![0; D::ENCODED_LEN];
        let used = data.ser(MavlinkVersion::V2, &mut payload);
        payload.truncate(used);
        Self { id: D::ID, seed: D::EXTRA_CRC, payload }
    }
}

impl Message {
    /// The same with other bytes in a field, which begins at `at`: a number for which the dialect has no name.
    pub(super) fn with_bytes<const N: usize>(mut self, at: usize, bytes: [u8; N]) -> Self {
        if self.payload.len() < at + N {
            self.payload.resize(at + N, 0);
        }
        self.payload[at..at + N].copy_from_slice(&bytes);
        self
    }

    /// The MAVLink 2 frame; signed where there is a key, at its time.
    pub(super) fn frame(
        &self,
        (sequence, system, component): (u8, u8, u8),
        signing: Option<(&Signing, u64)>,
    ) -> Vec<u8> {
        let used = self.payload.iter().rposition(|byte| *byte != 0).unwrap_or(0) + 1;
        let payload = &self.payload[..used.min(self.payload.len())];
        let [i0, i1, i2, _] = self.id.to_le_bytes();
        // no message has more than 255 bytes
        let length = u8::try_from(payload.len()).unwrap_or(u8::MAX);
        let flags = u8::from(signing.is_some());
        let mut frame = vec![MARKER_V2, length, flags, 0, sequence, system, component, i0, i1, i2];
        frame.extend_from_slice(payload);
        let sum = checksum(&frame[1..], self.seed);
        frame.extend_from_slice(&sum.to_le_bytes());
        if let Some((signing, time)) = signing {
            frame.extend_from_slice(&[0; TAIL_BYTES]);
            signing.sign_at(&mut frame, time);
        }
        frame
    }
}
