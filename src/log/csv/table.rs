//! The header of a table, and the rows below it.

use std::collections::BTreeSet;
use std::io::{BufRead, Chain, Cursor, Read};

use ::csv::{ByteRecord, Reader, ReaderBuilder};

use super::CsvError;
use super::bounded::{BUFFER, Bounded, ROW_BYTES_MAX};
use crate::text;

/// Columns of a table.
const COLUMNS_MAX: usize = 4096;

/// A table whose header was read.
pub(super) struct Table<R> {
    /// what is left of it
    pub rows: Reader<Bounded<Chain<Cursor<Vec<u8>>, R>>>,
    /// of the columns
    pub names: Vec<String>,
    /// between the cells
    pub delimiter: u8,
}

/// Reads the header. Without a delimiter the header tells it.
pub(super) fn open<R: BufRead>(
    mut reader: R,
    origin: &str,
    delimiter: Option<u8>,
) -> Result<Table<R>, CsvError> {
    let table_error = |source: ::csv::Error| CsvError::Table { origin: origin.to_owned(), source };
    let long = || CsvError::LongHeader { origin: origin.to_owned(), max: ROW_BYTES_MAX };
    let mut head = Vec::new();
    let mut limited = reader.by_ref().take(ROW_BYTES_MAX as u64);
    limited.read_until(b'\n', &mut head).map_err(|source| table_error(source.into()))?;
    if head.len() == ROW_BYTES_MAX && !head.ends_with(b"\n") {
        return Err(long());
    }
    head.drain(..head.len() - without_mark(&head).len());
    if let Some(what) = no_text(&head) {
        return Err(CsvError::NoText { origin: origin.to_owned(), what });
    }
    let delimiter = delimiter.unwrap_or_else(|| guess_delimiter(&head));
    let mut rows = ReaderBuilder::new()
        .delimiter(delimiter)
        .flexible(true)
        .buffer_capacity(BUFFER)
        .from_reader(Bounded::new(Cursor::new(head).chain(reader)));
    let header = match rows.byte_headers().cloned() {
        Ok(header) => header,
        Err(_) if rows.get_ref().is_exceeded() => return Err(long()),
        Err(source) => return Err(table_error(source)),
    };
    Ok(Table { rows, names: names(&header, origin)?, delimiter })
}

/// The names of the columns, each once.
fn names(header: &ByteRecord, origin: &str) -> Result<Vec<String>, CsvError> {
    if header.len() > COLUMNS_MAX {
        let (origin, came) = (origin.to_owned(), header.len());
        return Err(CsvError::ManyColumns { origin, max: COLUMNS_MAX, came });
    }
    let present: Vec<String> =
        header.iter().map(|name| text::clean(&String::from_utf8_lossy(name.trim_ascii()))).collect();
    let mut seen = BTreeSet::new();
    for column in present.iter().filter(|column| !column.is_empty()) {
        if !seen.insert(column) {
            return Err(CsvError::RepeatedColumn { origin: origin.to_owned(), column: column.clone() });
        }
    }
    Ok(present)
}

/// Without the mark that some programs put before text in UTF-8.
pub(super) fn without_mark(head: &[u8]) -> &[u8] {
    head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head)
}

/// What the first line is if it is no header at all.
pub(super) fn no_text(head: &[u8]) -> Option<&'static str> {
    let is_binary = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    if head.is_empty() {
        Some("an empty file")
    } else if head.iter().any(is_binary) {
        Some("binary data")
    } else {
        head.trim_ascii().is_empty().then_some("an empty line")
    }
}

/// Comma, semicolon or tab, whichever the header has most of; comma where it has none.
fn guess_delimiter(head: &[u8]) -> u8 {
    let count = |delimiter: u8| head.iter().filter(|byte| **byte == delimiter).count();
    let mut best = b',';
    for delimiter in [b';', b'\t'] {
        if count(delimiter) > count(best) {
            best = delimiter;
        }
    }
    best
}
