//! Reads binary logs message by message, over any reader, in bounded memory.
//!
//! The crate `ardupilot-binlog` (0.2) does not count what it skips, ends in silence after 256 errors and allocates several
//! times for every message; so this reader is our own.

use crate::autopilot::DATAFLASH_MARKER;
use std::io::Read;

use super::damage::DataflashDamage;
use super::definition::{FMT, HEADER_BYTES};
use super::definitions::{Definitions, Lesson};
use super::forms::{defined, mended};
use super::letter::MESSAGE_BYTES;
use super::message::Message;
use crate::log::error::LogError;
use crate::log::lookahead::LookAhead;

/// What must lie ahead for every judgement: a message and the header that confirms it.
const LOOKAHEAD: usize = *MESSAGE_BYTES.end() + HEADER_BYTES;

/// Reads a binary log of ArduPilot (`.bin`).
///
/// Messages carry no checksum. One is taken only where another header, or the end of the file, follows it. After damage
/// reading goes on at the next message that a second known one follows. All that is skipped is counted.
#[derive(Debug)]
pub struct DataflashReader<R: Read> {
    bytes: LookAhead<R>,
    /// bytes of the message that was given out last
    given: usize,
    /// the message before was a definition, or the log begins
    defines: bool,
    definitions: Definitions,
    /// where the damage begins that is being skipped
    skipping: Option<u64>,
    damage: DataflashDamage,
}

impl<R: Read> DataflashReader<R> {
    /// Reads from the start of `from`; no buffering of its own is needed.
    pub fn new(from: R) -> Self {
        Self {
            bytes: LookAhead::new(from),
            given: 0,
            defines: true,
            definitions: Definitions::default(),
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
        let offset = self.bytes.offset();
        self.given = bytes;
        self.defines = number == FMT;
        self.damage.messages += 1;
        let bytes = &self.bytes.sight()[..bytes];
        if self.definitions.teaches(number) {
            let lesson = match self.definitions.get(number) {
                _ if number == FMT => defined(bytes).map(Lesson::Definition),
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
        self.bytes.skip(std::mem::take(&mut self.given));
        loop {
            self.bytes.look(LOOKAHEAD)?;
            let offset = self.bytes.offset();
            self.damage.bytes = offset + self.bytes.sight().len() as u64;
            if self.bytes.sight().is_empty() {
                self.damage.tail_bytes = self.skipping.take().map_or(0, |from| offset - from);
                return Ok(None);
            }
            if let Some(found) = self.message() {
                if let Some(from) = self.skipping.take() {
                    self.damage.skip(from, offset - from);
                }
                return Ok(Some(found));
            }
            self.skipping.get_or_insert(offset);
            self.bytes.skip(self.to_next_marker());
        }
    }

    /// The whole message at the reading position, if another follows it.
    fn message(&self) -> Option<(u8, usize)> {
        let sight = self.bytes.sight();
        let Some(number) = self.number_at(0) else {
            // a log's definitions stand behind one another: the header of one may be damaged
            let bytes = self.definitions.bytes(FMT)?;
            return (self.defines && mended(sight.get(..bytes)?).is_some()).then_some((FMT, bytes));
        };
        let bytes = self.definitions.bytes(number)?;
        let whole = sight.get(..bytes)?;
        if number == FMT {
            // what it says speaks for it: nothing else need follow
            return defined(whole).map(|_| (number, bytes));
        }
        let followed = match self.number_at(bytes) {
            Some(number) => self.skipping.is_none() || self.definitions.bytes(number).is_some(),
            // the file may end within the next one
            None => {
                let rest = &sight[bytes..];
                self.bytes.is_all()
                    && DATAFLASH_MARKER.starts_with(&rest[..rest.len().min(DATAFLASH_MARKER.len())])
            }
        };
        followed.then_some((number, bytes))
    }

    /// The number in a header; `None` where none stands.
    fn number_at(&self, at: usize) -> Option<u8> {
        let header = self.bytes.sight().get(at..at + HEADER_BYTES)?;
        (header[..2] == DATAFLASH_MARKER).then_some(header[2])
    }

    /// Bytes to the place behind the reading position at which the next header may begin.
    fn to_next_marker(&self) -> usize {
        let sight = self.bytes.sight();
        let found = sight.iter().skip(1).position(|byte| *byte == DATAFLASH_MARKER[0]);
        found.map_or(sight.len(), |found| found + 1)
    }
}
