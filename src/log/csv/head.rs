//! The names of a table's columns, and the numbers of its first rows.

use std::io::BufRead;

use ::csv::ByteRecord;

use super::CsvError;
use super::rows::number;
use super::table::{Table, open};

/// Rows and numbers that are looked at, at most.
const ROWS_MAX: usize = 50_000;
const NUMBERS_MAX: usize = 4_000_000;

/// Names and first rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableHead {
    /// names of the columns, as mappings have them
    pub columns: Vec<String>,
    /// between the cells
    pub delimiter: u8,
    /// a number a column, NaN where the cell holds none
    pub rows: Vec<Vec<f64>>,
}

/// Reads the header of a table and its first rows, whatever its columns mean. `origin` is named in errors. Rows that cannot be
/// read are left out: [`super::read_table`] tells them.
///
/// # Errors
/// [`CsvError`] where there is no header.
pub fn read_head(reader: impl BufRead, origin: &str) -> Result<TableHead, CsvError> {
    let Table { rows: mut table, names: columns, delimiter } = open(reader, origin, None)?;
    let most = ROWS_MAX.min(NUMBERS_MAX / columns.len().max(1));
    let (mut rows, mut record) = (Vec::new(), ByteRecord::new());
    while rows.len() < most {
        table.get_mut().next_row();
        match table.read_byte_record(&mut record) {
            Ok(true) if record.len() == columns.len() => rows.push(
                columns
                    .iter()
                    .enumerate()
                    .map(|(index, column)| number(&record, index, column).unwrap_or(f64::NAN))
                    .collect(),
            ),
            Ok(true) => {}
            Ok(false) | Err(_) => break,
        }
    }
    Ok(TableHead { columns, delimiter, rows })
}
