//! Reads a table row by row and gives out what each holds.

use std::io::BufRead;

use ::csv::ByteRecord;

use super::bounded::ROW_BYTES_MAX;
use super::outlet::Outlet;
use super::rows::{Clock, cells_si, number};
use super::table::{Table, open};
use super::{CsvError, CsvMapping, CsvQuantity, CsvReport, convert};
use crate::log::format::{Place, Sink};
use crate::log::loss::RowRejection;
use crate::recording::StreamKey;

/// The source named in the keys of streams that came from a table.
const SOURCE: &str = "CSV";

/// Reads a table with a header row and gives each sample to `sink` as it comes (SI, body FLU, world NWU); memory does not
/// grow with the table. `origin` is named in errors.
///
/// # Errors
/// [`CsvError`] where the table cannot be read, lacks a column that is not optional, or has no usable row.
pub fn read_table(
    reader: impl BufRead,
    origin: &str,
    mapping: &CsvMapping,
    sink: &mut Sink<'_>,
) -> Result<CsvReport, CsvError> {
    let Table { mut rows, names, .. } = open(reader, origin, mapping.delimiter)?;
    let mut reading = Reading::new(names, origin, mapping, Outlet::new(sink))?;
    let mut record = ByteRecord::new();
    loop {
        rows.get_mut().next_row();
        let line = rows.position().line();
        match rows.read_byte_record(&mut record) {
            Ok(true) => reading.row(&record),
            Ok(false) => return reading.finish(),
            Err(_) if rows.get_ref().is_exceeded() => {
                reading.cut(line);
                return reading.finish();
            }
            Err(source) => return Err(CsvError::Table { origin: origin.to_owned(), source }),
        }
    }
}

/// A whole number, or nothing: all that is left of numbers whose decimal marks part cells.
fn is_whole(cell: &[u8]) -> bool {
    let digits = cell.trim_ascii().strip_prefix(b"-").unwrap_or(cell.trim_ascii());
    digits.iter().all(u8::is_ascii_digit)
}

/// A quantity that the file has.
struct Mapped {
    quantity: CsvQuantity,
    /// of its columns, in the record
    indices: Vec<usize>,
}

impl Mapped {
    fn key(&self) -> StreamKey {
        StreamKey { quantity: self.quantity.quantity, source: SOURCE, instance: self.quantity.instance }
    }
}

struct Reading<'a, 'b> {
    origin: &'a str,
    mapping: &'a CsvMapping,
    time_index: usize,
    columns: usize,
    mapped: Vec<Mapped>,
    clock: Clock,
    outlet: Outlet<'a, 'b>,
    report: CsvReport,
}

impl<'a, 'b> Reading<'a, 'b> {
    fn new(
        present: Vec<String>,
        origin: &'a str,
        mapping: &'a CsvMapping,
        outlet: Outlet<'a, 'b>,
    ) -> Result<Self, CsvError> {
        let mut missing = Vec::new();
        let time_index = index_of(&present, &mapping.time.column);
        if time_index.is_none() {
            missing.push(mapping.time.column.clone());
        }
        let mut mapped = Vec::new();
        for quantity in &mapping.quantities {
            match columns_of(quantity, &present) {
                Ok(None) => {}
                Ok(Some(found)) => mapped.push(found),
                Err(absent) => missing.extend(absent),
            }
        }
        let Some(time_index) = time_index.filter(|_| missing.is_empty()) else {
            return Err(CsvError::MissingColumns { origin: origin.to_owned(), missing, present });
        };
        if mapped.is_empty() {
            return Err(CsvError::NothingMapped { origin: origin.to_owned(), present });
        }
        let used = |index: &usize| *index == time_index || mapped.iter().any(|m| m.indices.contains(index));
        let unused_columns =
            (0..present.len()).filter(|index| !used(index)).map(|index| present[index].clone()).collect();
        Ok(Self {
            origin,
            mapping,
            time_index,
            columns: present.len(),
            mapped,
            clock: Clock::default(),
            outlet,
            report: CsvReport { unused_columns, ..CsvReport::default() },
        })
    }

    fn row(&mut self, record: &ByteRecord) {
        self.report.rows += 1;
        match self.cells(record) {
            Ok((raw_time, cells)) => self.keep(record.position(), raw_time, cells),
            Err(reason) => self.reject(record.position().map_or(0, ::csv::Position::line), reason),
        }
    }

    fn reject(&mut self, line: u64, reason: String) {
        self.report.rows_rejected += 1;
        if self.report.rejections.len() < CsvReport::REJECTIONS_KEPT {
            self.report.rejections.push(RowRejection { line, reason });
        }
    }

    /// The row that begins in this line does not end: what stands behind it cannot be told from it.
    fn cut(&mut self, line: u64) {
        self.report.rows += 1;
        self.report.cut_at_line = Some(line);
        let expected = format!("expected a row of at most {ROW_BYTES_MAX} bytes, came a longer one");
        self.reject(line, format!("{expected} (a quote that is not closed?)"));
    }

    /// The row's raw time and the cells of each quantity, or why the row is of no use.
    fn cells(&self, record: &ByteRecord) -> Result<(f64, Vec<Vec<f64>>), String> {
        if record.len() != self.columns {
            let why = if 2 * record.len() > 3 * self.columns && record.iter().all(is_whole) {
                ": are commas both between the cells and decimal marks? Write numbers with a decimal point"
            } else {
                ""
            };
            return Err(format!(
                "expected {} cells as in the header, came {}{why}",
                self.columns,
                record.len()
            ));
        }
        let column = &self.mapping.time.column;
        let raw_time = number(record, self.time_index, column)?;
        if raw_time.is_nan() {
            return Err(format!("column \"{column}\": expected a time, came nothing"));
        }
        let cells = self.mapped.iter().map(|m| cells_si(&m.quantity, &m.indices, record));
        Ok((raw_time, cells.collect::<Result<_, _>>()?))
    }

    fn keep(&mut self, position: Option<&::csv::Position>, raw_time: f64, cells: Vec<Vec<f64>>) {
        let place = Place { offset: position.map_or(0, ::csv::Position::byte), arrival_us: None };
        let line = || position.map_or(0, ::csv::Position::line);
        let row = self.clock.row(&self.mapping.time, raw_time);
        if row.is_repeat {
            self.report.rows_repeating_a_time += 1;
            self.report.first_repeat_line.get_or_insert_with(line);
        }
        if let Some(stamp_s) = row.reset_s {
            self.outlet.reset(place, row.time_s, stamp_s);
        }
        for (mapped, cells) in self.mapped.iter().zip(cells) {
            if cells.iter().all(|cell| cell.is_nan()) {
                continue;
            }
            match convert::to_sample(&mapped.quantity, &cells) {
                None => {
                    self.report.invalid_attitudes += 1;
                    self.report.first_invalid_attitude_line.get_or_insert_with(line);
                }
                Some(sample) => self.outlet.sample(place, mapped.key(), row.time_s, sample),
            }
        }
        self.outlet.row(row.time_s, self.clock.latest_s());
    }

    fn finish(mut self) -> Result<CsvReport, CsvError> {
        let Some(first_row_s) = self.clock.first_row_s(&self.mapping.time) else {
            let (origin, rows) = (self.origin.to_owned(), self.report.rows);
            let first = self.report.rejections.into_iter().next();
            return Err(CsvError::NoRows { origin, rows, first });
        };
        self.report.rows_out_of_order = self.clock.out_of_order;
        self.report.clock_resets = self.clock.resets;
        self.report.start_time_s = first_row_s + self.outlet.finish();
        Ok(self.report)
    }
}

fn index_of(present: &[String], column: &str) -> Option<usize> {
    present.iter().position(|name| name == column)
}

/// Where the columns of a quantity are. `Ok(None)`: the file does without; `Err`: what it lacks.
fn columns_of(quantity: &CsvQuantity, present: &[String]) -> Result<Option<Mapped>, Vec<String>> {
    let columns = match quantity.columns.as_slice() {
        [pattern] if pattern.contains("{n}") => numbered(pattern, present),
        columns => columns.to_vec(),
    };
    let absent: Vec<String> =
        columns.iter().filter(|column| index_of(present, column).is_none()).cloned().collect();
    if absent.len() == columns.len() {
        return if quantity.optional { Ok(None) } else { Err(quantity.columns.clone()) };
    }
    if !absent.is_empty() {
        return Err(absent);
    }
    let indices = columns.iter().filter_map(|column| index_of(present, column)).collect();
    let quantity = CsvQuantity { columns, ..quantity.clone() };
    Ok(Some(Mapped { quantity, indices }))
}

/// `motor_{n}_command` to `motor_1_command`, `motor_2_command` and so on, as far as the header goes.
fn numbered(pattern: &str, present: &[String]) -> Vec<String> {
    (1..=present.len())
        .map(|number| pattern.replace("{n}", &number.to_string()))
        .take_while(|column| index_of(present, column).is_some())
        .collect()
}
