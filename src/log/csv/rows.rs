//! One row at a time: its time on one clock, its cells as numbers.

use ::csv::ByteRecord;

use super::{CsvQuantity, CsvTime};
use crate::text;

/// Characters of a cell, or of its column's name, that a rejection repeats.
const CELL_CHARS: usize = 40;

/// A step back by more than this is taken for a clock that started anew, a smaller one for rows out of order.
pub(super) const CLOCK_RESET_S: f64 = 1.0;

/// A step ahead by more than this too: a clock that was set, or a damaged cell.
const CLOCK_LEAP_S: f64 = 3600.0;

/// The row's times on one clock, seconds from the first row.
#[derive(Default)]
pub(super) struct Clock {
    /// raw time of the first row
    first: Option<f64>,
    /// added after a reset
    offset_s: f64,
    /// largest so far
    latest_s: f64,
    /// where the clock started anew
    pub resets_s: Vec<f64>,
    /// rows behind a row above
    pub out_of_order: usize,
}

impl Clock {
    /// The time of a row. After a reset the clock goes on [`CLOCK_RESET_S`] after the latest time: how long the
    /// pause was is not known.
    pub fn time_s(&mut self, time: &CsvTime, raw: f64) -> f64 {
        let Some(first) = self.first else {
            self.first = Some(raw);
            return 0.0;
        };
        let since_first_s = time.unit.to_si((raw - first) * time.scale);
        let mut time_s = since_first_s + self.offset_s;
        if !(-CLOCK_RESET_S..=CLOCK_LEAP_S).contains(&(time_s - self.latest_s)) {
            self.offset_s = self.latest_s + CLOCK_RESET_S - since_first_s;
            time_s = self.latest_s + CLOCK_RESET_S;
            self.resets_s.push(time_s);
        } else if time_s < self.latest_s {
            self.out_of_order += 1;
        }
        self.latest_s = self.latest_s.max(time_s);
        time_s
    }

    /// What the time column says in the first row, s.
    pub fn start_s(&self, time: &CsvTime) -> f64 {
        self.first.map_or(f64::NAN, |raw| time.unit.to_si(raw * time.scale))
    }
}

/// A cell as a number: NaN where empty or `nan`, else finite.
pub(super) fn number(record: &ByteRecord, index: usize, column: &str) -> Result<f64, String> {
    let cell = record.get(index).unwrap_or_default().trim_ascii();
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    let text = String::from_utf8_lossy(cell);
    match text.parse::<f64>() {
        Ok(value) if !value.is_infinite() => Ok(value),
        // binary garbage need not be repeated whole
        _ => Err(format!(
            "column \"{}\": expected a number, came \"{}\"",
            text::excerpt(column, CELL_CHARS),
            text::excerpt(&text, CELL_CHARS)
        )),
    }
}

/// The cells of one quantity in SI, NaN where missing.
pub(super) fn cells_si(
    mapped: &CsvQuantity,
    indices: &[usize],
    record: &ByteRecord,
) -> Result<Vec<f64>, String> {
    let mut cells = Vec::with_capacity(indices.len());
    for (&index, column) in indices.iter().zip(&mapped.columns) {
        let raw = number(record, index, column)?;
        let known = !mapped.missing.contains(&raw);
        cells.push(if known { mapped.unit.to_si(raw * mapped.scale) } else { f64::NAN });
    }
    Ok(cells)
}
