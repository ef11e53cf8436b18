//! One message of a log, binary or text.

use std::borrow::Cow;

use super::definition::Definition;
use super::letter::{ARRAY_VALUES, Letter};
use crate::text;

/// One message.
#[derive(Debug, Clone, Copy)]
pub struct Message<'a> {
    /// byte offset in the file
    pub offset: u64,
    /// what it is made of
    pub definition: &'a Definition,
    body: Body<'a>,
}

#[derive(Debug, Clone, Copy)]
enum Body<'a> {
    /// with its header
    Bytes(&'a [u8]),
    /// a line of text and where its cells are
    Cells(&'a str, &'a [(usize, usize)]),
}

/// A message that waits until it can be read, with what it is made of.
#[derive(Debug)]
pub(super) struct Kept {
    offset: u64,
    definition: Definition,
    body: KeptBody,
}

#[derive(Debug)]
enum KeptBody {
    Bytes(Vec<u8>),
    Cells(String, Vec<(usize, usize)>),
}

impl Kept {
    pub(super) fn of(message: &Message<'_>) -> Self {
        let body = match message.body {
            Body::Bytes(bytes) => KeptBody::Bytes(bytes.to_vec()),
            Body::Cells(line, cells) => KeptBody::Cells(line.to_owned(), cells.to_vec()),
        };
        Self { offset: message.offset, definition: message.definition.clone(), body }
    }

    pub(super) fn message(&self) -> Message<'_> {
        match &self.body {
            KeptBody::Bytes(bytes) => Message::binary(self.offset, &self.definition, bytes),
            KeptBody::Cells(line, cells) => Message::line(self.offset, &self.definition, line, cells),
        }
    }
}

impl<'a> Message<'a> {
    pub(super) fn binary(offset: u64, definition: &'a Definition, bytes: &'a [u8]) -> Self {
        Self { offset, definition, body: Body::Bytes(bytes) }
    }

    pub(super) fn line(
        offset: u64,
        definition: &'a Definition,
        line: &'a str,
        cells: &'a [(usize, usize)],
    ) -> Self {
        Self { offset, definition, body: Body::Cells(line, cells) }
    }

    /// The number in a field, scaled as its letter says; NaN for what is no number.
    #[must_use]
    pub fn number(&self, field: usize) -> f64 {
        match self.body {
            Body::Bytes(bytes) => match self.definition.fields.get(field) {
                Some(field) => field.letter.number(bytes.get(field.offset..).unwrap_or_default()),
                None => f64::NAN,
            },
            Body::Cells(..) => self.cell(field).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN),
        }
    }

    /// The text in a field: for a number of a binary log none.
    #[must_use]
    pub fn text(&self, field: usize) -> Cow<'a, str> {
        match self.body {
            Body::Bytes(_) => {
                let bytes = self.raw(field).unwrap_or_default();
                let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
                match std::str::from_utf8(&bytes[..end]) {
                    Ok(whole) if !whole.chars().any(text::is_command) => Cow::Borrowed(whole),
                    _ => Cow::Owned(text::clean(&String::from_utf8_lossy(&bytes[..end]))),
                }
            }
            Body::Cells(..) => {
                let cell = self.cell(field).unwrap_or_default();
                if cell.chars().any(text::is_command) {
                    Cow::Owned(text::clean(cell))
                } else {
                    Cow::Borrowed(cell)
                }
            }
        }
    }

    /// The values of an array (letter `a`); `None` for another field, and in a text log.
    #[must_use]
    pub fn array(&self, field: usize) -> Option<[i16; ARRAY_VALUES]> {
        let Body::Bytes(bytes) = self.body else { return None };
        let field = self.definition.fields.get(field).filter(|field| field.letter == Letter::Array)?;
        let bytes = bytes.get(field.offset..)?.first_chunk::<{ 2 * ARRAY_VALUES }>()?;
        Some(std::array::from_fn(|index| i16::from_le_bytes([bytes[2 * index], bytes[2 * index + 1]])))
    }

    /// The bytes of a text field in a binary log.
    pub(super) fn raw(&self, field: usize) -> Option<&'a [u8]> {
        let Body::Bytes(bytes) = self.body else { return None };
        let field = self.definition.fields.get(field)?;
        let Letter::Text(length) = field.letter else { return None };
        bytes.get(field.offset..field.offset + usize::from(length))
    }

    fn cell(&self, field: usize) -> Option<&'a str> {
        let Body::Cells(line, cells) = self.body else { return None };
        let (from, to) = *cells.get(field)?;
        line.get(from..to).map(str::trim)
    }
}
