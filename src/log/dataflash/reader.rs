//! Reads binary logs message by message, over any reader, in bounded memory.
//!
//! The crate `ardupilot-binlog` (0.2) does not count what it skips, ends in silence after 256 errors and allocates several
//! times for every message; so this reader is our own.

use std::io::Read;

use super::damage::DataflashDamage;
use super::definition::{Definition, FMT, HEADER_BYTES, MARKER};
use super::definitions::{Definitions, Lesson};
use super::letter::MESSAGE_BYTES;
use super::message::Message;
use crate::log::error::LogError;

const BUFFER_BYTES: usize = 1 << 18;
/// What must lie ahead for every judgement: a message and the header that confirms it.
const LOOKAHEAD: usize = *MESSAGE_BYTES.end() + HEADER_BYTES;

/// Reads a binary log of ArduPilot (`.bin`).
///
/// Messages carry no checksum. One is taken only where another header, or the end of the file, follows it. After damage
/// reading goes on at the next message that a second known one follows. All that is skipped is counted.
#[derive(Debug)]
pub struct DataflashReader<R: Read> {
    from: R,
    definitions: Definitions,
    buffer: Vec<u8>,
    at: usize,
    filled: usize,
    ended: bool,
    base: u64,
    /// where the damage begins that is being skipped
    skipping: Option<u64>,
    damage: DataflashDamage,
}

impl<R: Read> DataflashReader<R> {
    /// Reads from the start of `from`; no buffering of its own is needed.
    pub fn new(from: R) -> Self {
        Self {
            from,
            definitions: Definitions::default(),
            buffer: vec![0; BUFFER_BYTES],
            at: 0,
            filled: 0,
            ended: false,
            base: 0,
            skipping: None,
            damage: DataflashDamage::default(),
        }
    }

    /// The next message, definitions included; `None` at the end.
    ///
    /// # Errors
    /// The reader beneath fails.
    pub fn next_message(&mut self) -> Result<Option<Message<'_>>, LogError> {
        Ok(self.next_with_definitions()?.map(|(message, _)| message))
    }

    /// The next message, and what is defined up to it.
    pub(super) fn next_with_definitions(&mut self) -> Result<Option<(Message<'_>, &Definitions)>, LogError> {
        let Some((number, bytes)) = self.advance()? else { return Ok(None) };
        let (start, offset) = (self.at, self.base + self.at as u64);
        self.at += bytes;
        self.damage.messages += 1;
        let bytes = &self.buffer[start..self.at];
        if self.definitions.teaches(number) {
            let lesson = match self.definitions.get(number) {
                _ if number == FMT => Definition::from_message(bytes).map(Lesson::Definition),
                Some(definition) => Definitions::lesson(&Message::binary(offset, definition, bytes)),
                None => None,
            };
            lesson.into_iter().for_each(|lesson| self.definitions.learn(lesson));
        }
        let definitions = &self.definitions;
        Ok(definitions.get(number).map(|of| (Message::binary(offset, of, bytes), definitions)))
    }

    /// What the log has defined so far.
    #[must_use]
    pub fn definitions(&self) -> &Definitions {
        &self.definitions
    }

    /// What could not be read so far; complete once `next_message` has returned `None`.
    #[must_use]
    pub fn damage(&self) -> &DataflashDamage {
        &self.damage
    }

    /// Moves to the next message: its number and its bytes.
    fn advance(&mut self) -> Result<Option<(u8, usize)>, LogError> {
        loop {
            self.look_ahead()?;
            let offset = self.base + self.at as u64;
            if self.at == self.filled {
                self.damage.tail_bytes = self.skipping.take().map_or(0, |from| offset - from);
                return Ok(None);
            }
            if let Some(found) = self.message_at(self.at) {
                if let Some(from) = self.skipping.take() {
                    self.damage.skip(from, offset - from);
                }
                return Ok(Some(found));
            }
            self.skipping.get_or_insert(offset);
            self.at = self.next_marker(self.at + 1);
        }
    }

    /// The whole message that begins at `at`, if another follows it.
    fn message_at(&self, at: usize) -> Option<(u8, usize)> {
        let number = self.number_at(at)?;
        let bytes = self.definitions.bytes(number)?;
        let next = at + bytes;
        if next > self.filled || number == FMT && Definition::from_message(&self.buffer[at..next]).is_none() {
            return None;
        }
        let followed = match self.number_at(next) {
            Some(number) => self.skipping.is_none() || self.definitions.bytes(number).is_some(),
            // the file may end within the next one
            None => {
                self.ended && MARKER.starts_with(&self.buffer[next..self.filled.min(next + MARKER.len())])
            }
        };
        followed.then_some((number, bytes))
    }

    /// The number in a header; `None` where none stands.
    fn number_at(&self, at: usize) -> Option<u8> {
        let header = self.buffer[..self.filled].get(at..at + HEADER_BYTES)?;
        (header[..2] == MARKER).then_some(header[2])
    }

    /// Where the next header may begin, from `from` on.
    fn next_marker(&self, from: usize) -> usize {
        let left = &self.buffer[from.min(self.filled)..self.filled];
        let found = left.iter().position(|byte| *byte == MARKER[0]);
        found.map_or(self.filled, |found| from + found)
    }

    /// Makes sure that enough bytes lie ahead, or all that are left.
    fn look_ahead(&mut self) -> Result<(), LogError> {
        if self.ended || self.filled - self.at >= LOOKAHEAD {
            return Ok(());
        }
        self.buffer.copy_within(self.at..self.filled, 0);
        self.base += self.at as u64;
        self.filled -= self.at;
        self.at = 0;
        while self.filled < self.buffer.len() {
            match self.from.read(&mut self.buffer[self.filled..]) {
                Ok(0) => {
                    self.ended = true;
                    break;
                }
                Ok(bytes) => self.filled += bytes,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(source) => {
                    return Err(LogError::Read { offset: self.base + self.filled as u64, source });
                }
            }
        }
        self.damage.bytes = self.base + self.filled as u64;
        Ok(())
    }
}
