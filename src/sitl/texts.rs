//! What the vehicle says in words, on its links and in its log.

use crate::wire::STATUSTEXT_BYTES;
use mavlink::dialects::ardupilotmega::STATUSTEXT_DATA;

use super::Vehicle;
use super::autopilot::Text;
use super::message::Message;

impl Vehicle {
    /// Texts longer than a message go out in numbered chunks.
    pub(super) fn send_texts(&mut self) {
        while let Some(said) = self.autopilot.texts.pop_front() {
            self.keeper.text(self.now(), &said);
            let Text { severity, text } = said;
            let bytes = text.as_bytes();
            let is_long = bytes.len() > STATUSTEXT_BYTES;
            if is_long {
                self.texts = self.texts.wrapping_add(1).max(1);
            }
            for (chunk, part) in bytes.chunks(STATUSTEXT_BYTES).enumerate() {
                let mut text = [0; STATUSTEXT_BYTES];
                text[..part.len()].copy_from_slice(part);
                let message = Message::from(STATUSTEXT_DATA {
                    severity,
                    text: text.into(),
                    id: if is_long { self.texts } else { 0 },
                    chunk_seq: u8::try_from(chunk).unwrap_or(u8::MAX),
                });
                self.broadcast(&message);
            }
        }
    }
}
