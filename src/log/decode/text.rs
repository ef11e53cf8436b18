//! STATUSTEXT: texts longer than 50 bytes come in chunks.

use super::Event;
use crate::log::frame::Payload;

const CHUNK_BYTES: usize = 50;
/// No text is longer: 255 chunks is what a broken sender could make of it.
const MAX_CHUNKS: u8 = 16;

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
    text: String,
}

impl Texts {
    /// Takes one message; gives out each text that it completes.
    pub(super) fn take(&mut self, payload: Payload<'_>, time_s: f64, sink: &mut impl FnMut(Event<'_>)) {
        let (id, chunk) = (payload.u16(51), payload.u8(53));
        let text = payload.text(1, CHUNK_BYTES);
        let last = text.len() < CHUNK_BYTES || chunk >= MAX_CHUNKS;
        let continued = self.open.as_mut().filter(|open| id != 0 && open.id == id && chunk > 0);
        match continued {
            Some(open) => {
                if chunk != open.next_chunk {
                    open.text.push_str("[...]");
                }
                open.text.push_str(&text);
                open.next_chunk = chunk.saturating_add(1);
            }
            None => {
                self.finish(sink);
                let text = if chunk > 0 { format!("[...]{text}") } else { text };
                self.open = Some(Open {
                    id,
                    next_chunk: chunk.saturating_add(1),
                    time_s,
                    severity: payload.u8(0),
                    text,
                });
            }
        }
        if id == 0 || last {
            self.finish(sink);
        }
    }

    /// Gives out what is there of a text whose end did not come.
    pub(super) fn finish(&mut self, sink: &mut impl FnMut(Event<'_>)) {
        if let Some(open) = self.open.take() {
            let (time_s, severity) = (open.time_s, open.severity);
            sink(Event::Text { time_s, severity, text: open.text.trim_end() });
        }
    }
}
