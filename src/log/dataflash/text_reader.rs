//! Reads text logs line by line, over any reader, in bounded memory.

use std::io::{BufRead, Read};

use super::damage::DataflashDamage;
use super::definition::Definition;
use super::definitions::{Definitions, Lesson};
use super::letter::Letter;
use super::message::Message;
use crate::log::error::LogError;
use crate::log::loss::RowRejection;
use crate::text;

/// A line is cut here: no message is longer.
const LINE_BYTES: u64 = 1 << 12;
/// Lines kept of what stands before the definitions.
const PREAMBLE_LINES: usize = 16;
/// Characters told of a line that cannot be used.
const TOLD: usize = 40;

/// Reads a text log of ArduPilot (`.log`): a message a line, its name first. Numbers in it are scaled already.
#[derive(Debug)]
pub struct DataflashTextReader<R: BufRead> {
    from: R,
    definitions: Definitions,
    line: Vec<u8>,
    text: String,
    cells: Vec<(usize, usize)>,
    number: u64,
    preamble: Vec<String>,
    damage: DataflashDamage,
}

impl<R: BufRead> DataflashTextReader<R> {
    /// Reads from the start of `from`.
    pub fn new(from: R) -> Self {
        Self {
            from,
            definitions: Definitions::default(),
            line: Vec::new(),
            text: String::new(),
            cells: Vec::new(),
            number: 0,
            preamble: Vec::new(),
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
        loop {
            let offset = self.damage.bytes;
            if !self.next_line()? {
                return Ok(None);
            }
            if let Some(number) = self.judge() {
                self.damage.messages += 1;
                let definitions = &self.definitions;
                let definition = definitions.get(number);
                return Ok(
                    definition.map(|of| (Message::line(offset, of, &self.text, &self.cells), definitions))
                );
            }
        }
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

    /// What stands before the first definition: the software's name, in old logs.
    #[must_use]
    pub fn preamble(&self) -> &[String] {
        &self.preamble
    }

    fn next_line(&mut self) -> Result<bool, LogError> {
        self.line.clear();
        let read = Read::by_ref(&mut self.from).take(LINE_BYTES).read_until(b'\n', &mut self.line);
        let bytes = read.map_err(|source| LogError::Read {
            offset: self.damage.bytes + self.line.len() as u64,
            source,
        })?;
        self.damage.bytes += bytes as u64;
        self.number += 1;
        self.text.clear();
        self.text.push_str(String::from_utf8_lossy(&self.line).trim());
        Ok(bytes > 0)
    }

    /// Takes the line apart: the number of its definition, `None` where it is no message.
    fn judge(&mut self) -> Option<u8> {
        let name = self.text.split(',').next().unwrap_or_default().trim();
        let Some(definition) = self.definitions.named(name).filter(|_| !name.is_empty()) else {
            if self.damage.messages == 0 && self.preamble.len() < PREAMBLE_LINES {
                self.preamble.push(text::clean(&self.text));
            }
            self.damage.lines_unknown += 1;
            return None;
        };
        let number = definition.number;
        let ends_in_text =
            definition.fields.last().is_some_and(|last| matches!(last.letter, Letter::Text(_)));
        let (wanted, at) = (definition.fields.len(), name.len());
        self.split(at, ends_in_text.then_some(wanted));
        let definition = self.definitions.get(number)?;
        if self.cells.len() != wanted || self.damage.messages > 0 && !self.line.ends_with(b"\n") {
            self.reject(wanted);
            return None;
        }
        let lesson = match definition.name.as_str() {
            "FMT" => match self.defined() {
                Some(defined) => Some(Lesson::Definition(defined)),
                None => {
                    self.reject(wanted);
                    return None;
                }
            },
            _ if self.definitions.teaches(number) => {
                Definitions::lesson(&Message::line(0, definition, &self.text, &self.cells))
            }
            _ => None,
        };
        lesson.into_iter().for_each(|lesson| self.definitions.learn(lesson));
        Some(number)
    }

    /// Where the cells after the name are; the last of `most` takes what is left, commas included.
    fn split(&mut self, mut at: usize, most: Option<usize>) {
        self.cells.clear();
        while let Some(rest) = self.text.get(at + 1..).filter(|_| at < self.text.len()) {
            let is_last = most.is_some_and(|most| self.cells.len() + 1 == most);
            let length = rest.find(',').filter(|_| !is_last).unwrap_or(rest.len());
            self.cells.push((at + 1, at + 1 + length));
            at += 1 + length;
        }
    }

    fn defined(&self) -> Option<Definition> {
        let cell = |index: usize| {
            let (from, to) = *self.cells.get(index)?;
            self.text.get(from..to).map(str::trim)
        };
        let (number, bytes) = (cell(0)?.parse().ok()?, cell(1)?.parse().ok()?);
        Definition::new(number, bytes, cell(2)?, cell(3)?, cell(4)?)
    }

    fn reject(&mut self, wanted: usize) {
        self.damage.lines_rejected += 1;
        let (line, came) = (self.number, text::excerpt(&self.text, TOLD));
        let reason =
            format!("expected {wanted} values as its FMT says, came {} in \"{came}\"", self.cells.len());
        self.damage.first_rejection.get_or_insert(RowRejection { line, reason });
    }
}
