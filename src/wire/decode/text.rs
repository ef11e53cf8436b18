//! STATUSTEXT: texts longer than 50 bytes come in chunks.

use crate::recording::Event;
use crate::text;
use crate::wire::frame::Payload;

/// Bytes of text in one STATUSTEXT, by the message's definition.
pub const STATUSTEXT_BYTES: usize = 50;
/// No text has more, whatever a broken sender counts.
const MAX_CHUNKS: u8 = 16;
/// What stands where a chunk did not come.
const GAP: &[u8] = b"[...]";

/// Puts texts together.
#[derive(Debug, Default)]
pub(super) struct Texts {
    open: Option<Open>,
}

#[derive(Debug)]
struct Open {
    id: u16,
    next_chunk: u8,
    time_s: f64,
    severity: u8,
    chunks: u8,
    /// as it came: a letter may lie in two chunks
    bytes: Vec<u8>,
}

impl Texts {
    /// Takes one message; gives out each text that it completes.
    pub(super) fn take(&mut self, payload: Payload<'_>, time_s: f64, sink: &mut impl FnMut(Event<'_>)) {
        let (id, chunk) = (payload.u16(51), payload.u8(53));
        let bytes = payload.text_bytes(1, STATUSTEXT_BYTES);
        let continued = self.open.as_mut().filter(|open| id != 0 && open.id == id && chunk > 0);
        match continued {
            Some(open) => {
                if chunk != open.next_chunk {
                    open.bytes.extend_from_slice(GAP);
                }
                open.bytes.extend_from_slice(bytes);
                open.next_chunk = chunk.saturating_add(1);
                open.chunks += 1;
            }
            None => {
                self.finish(sink);
                let begin = if chunk > 0 { GAP } else { &[] };
                self.open = Some(Open {
                    id,
                    next_chunk: chunk.saturating_add(1),
                    time_s,
                    severity: payload.u8(0),
                    chunks: 1,
                    bytes: [begin, bytes].concat(),
                });
            }
        }
        let full = self.open.as_ref().is_some_and(|open| open.chunks >= MAX_CHUNKS);
        if id == 0 || bytes.len() < STATUSTEXT_BYTES || chunk >= MAX_CHUNKS || full {
            self.finish(sink);
        }
    }

    /// Gives out what is there of a text whose end did not come.
    pub(super) fn finish(&mut self, sink: &mut impl FnMut(Event<'_>)) {
        if let Some(open) = self.open.take() {
            let (time_s, severity) = (open.time_s, open.severity);
            // PX4 ends a text with a tab where it tells the same as an event
            let text = text::clean(String::from_utf8_lossy(&open.bytes).trim_end());
            sink(Event::Text { time_s, severity, text: &text });
        }
    }
}
