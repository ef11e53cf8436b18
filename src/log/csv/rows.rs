//! One row at a time: its time on one clock, its cells as numbers.

use std::collections::VecDeque;

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
    /// in order: times of rows that another may still repeat
    recent_s: VecDeque<f64>,
    /// how often it started anew
    pub resets: usize,
    /// rows behind a row above
    pub out_of_order: usize,
}

/// A row on that clock.
pub(super) struct RowTime {
    /// s from the first row
    pub time_s: f64,
    /// what the time column says, s, where the clock starts anew here
    pub reset_s: Option<f64>,
    /// a row above has the same time
    pub is_repeat: bool,
}

impl Clock {
    /// The time of a row. After a reset the clock goes on [`CLOCK_RESET_S`] after the latest time: how long the
    /// pause was is not known.
    pub fn row(&mut self, time: &CsvTime, raw: f64) -> RowTime {
        let since_first_s = time.unit.to_si((raw - *self.first.get_or_insert(raw)) * time.scale);
        let mut time_s = since_first_s + self.offset_s;
        let mut reset_s = None;
        if !(-CLOCK_RESET_S..=CLOCK_LEAP_S).contains(&(time_s - self.latest_s)) {
            self.offset_s = self.latest_s + CLOCK_RESET_S - since_first_s;
            time_s = self.latest_s + CLOCK_RESET_S;
            self.resets += 1;
            reset_s = Some(time.unit.to_si(raw * time.scale));
        } else if time_s < self.latest_s {
            self.out_of_order += 1;
        }
        self.latest_s = self.latest_s.max(time_s);
        RowTime { time_s, reset_s, is_repeat: self.is_repeat(time_s) }
    }

    /// Whether a row above has this time, which is noted.
    fn is_repeat(&mut self, time_s: f64) -> bool {
        // with a margin: no row lies further back than a reset
        while self.recent_s.front().is_some_and(|first_s| *first_s < self.latest_s - 2.0 * CLOCK_RESET_S) {
            self.recent_s.pop_front();
        }
        let at = self.recent_s.partition_point(|known_s| *known_s < time_s);
        if self.recent_s.get(at) == Some(&time_s) {
            return true;
        }
        self.recent_s.insert(at, time_s);
        false
    }

    /// The latest time so far, s from the first row.
    pub fn latest_s(&self) -> f64 {
        self.latest_s
    }

    /// What the time column says in the first row, s; `None` before it.
    pub fn first_row_s(&self, time: &CsvTime) -> Option<f64> {
        self.first.map(|raw| time.unit.to_si(raw * time.scale))
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
        _ => {
            let (column, came) = (text::excerpt(column, CELL_CHARS), text::excerpt(&text, CELL_CHARS));
            let is_decimal_comma =
                text.matches(',').count() == 1 && text.replace(',', ".").parse::<f64>().is_ok();
            let why = if is_decimal_comma { ": write it with a decimal point" } else { "" };
            Err(format!("column \"{column}\": expected a number, came \"{came}\"{why}"))
        }
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
