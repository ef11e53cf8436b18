//! Tables as JSON lines: one object a row.

use super::cell::Cell;
use super::column::{Column, Kind};
use super::rows::{Row, TableError};
use crate::text;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

/// A row with its names.
struct Named<'a>(&'a [Column], &'a [Cell]);

impl Serialize for Named<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (column, cell) in self.0.iter().zip(self.1) {
            map.serialize_entry(column.name, &value(cell))?;
        }
        map.end()
    }
}

fn value(cell: &Cell) -> Value {
    match cell {
        Cell::Empty => Value::Null,
        Cell::Text(text) => Value::from(text.as_str()),
        Cell::Number(number) => Value::from(*number),
        Cell::Whole(whole) => Value::from(*whole),
        Cell::Truth(truth) => Value::from(*truth),
        Cell::Numbers(numbers) => Value::from(numbers.clone()),
    }
}

/// The rows as text, one object a line.
///
/// # Errors
/// [`TableError::File`] where a value has no form in JSON.
pub fn to_json_lines<R: Row>(rows: &[R]) -> Result<String, TableError> {
    let columns = R::columns();
    let mut out = String::new();
    for row in rows {
        let line = text::json_line(&Named(&columns, &row.cells()))
            .map_err(|error| TableError::File { table: R::TABLE, why: error.to_string() })?;
        out.push_str(&line);
        out.push('\n');
    }
    Ok(out)
}

/// The rows as JSON objects.
#[must_use]
pub fn to_values<R: Row>(rows: &[R]) -> Vec<Value> {
    let columns = R::columns();
    let object = |row: &R| {
        let cells = row.cells();
        columns.iter().zip(&cells).map(|(column, cell)| (column.name.to_owned(), value(cell))).collect()
    };
    rows.iter().map(|row| Value::Object(object(row))).collect()
}

/// The rows of such a text. Columns that are not known are left out; one that is missing is empty.
///
/// # Errors
/// [`TableError`] where a line is no object, or a column holds another kind.
pub fn from_json_lines<R: Row>(text: &str) -> Result<Vec<R>, TableError> {
    let columns = R::columns();
    let read = |(index, line): (usize, &str)| {
        let refused = |why: String| TableError::Line { table: R::TABLE, line: index + 1, why };
        let value: Value = serde_json::from_str(line).map_err(|error| refused(error.to_string()))?;
        let object = value.as_object().ok_or_else(|| refused("another value".to_owned()))?;
        let cell =
            |column: &Column| object.get(column.name).map_or(Cell::Empty, |value| cell(value, column.kind));
        R::of_cells(columns.iter().map(cell).collect())
    };
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(read).collect()
}

/// A number that is not finite has no form in JSON, and stands there as nothing.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn cell(value: &Value, kind: Kind) -> Cell {
    let found = match kind {
        Kind::Text => value.as_str().map(|text| Cell::Text(text.to_owned())),
        Kind::Number => value.as_f64().map(Cell::Number),
        Kind::Whole => value.as_i64().map(Cell::Whole),
        Kind::Truth => value.as_bool().map(Cell::Truth),
        Kind::Numbers => value.as_array().map(|all| Cell::Numbers(all.iter().map(number).collect())),
    };
    found.unwrap_or(Cell::Empty)
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::table_rows! {
        Sample, "samples", "a sample" {
            name: String, "", "its name";
            value: Option<f64>, "m", "how long it is";
            count: i64, "1", "how many there are";
            is_good: bool, "", "whether it is good";
            series: Vec<f64>, "N", "what was measured";
        }
    }

    #[test]
    fn rows_read_back_are_the_same_and_a_wrong_kind_is_told() {
        let row = |value| Sample {
            name: "a\u{1b}\"".to_owned(),
            value,
            count: 3,
            is_good: true,
            series: vec![1.0, -0.1],
        };
        let rows = vec![row(Some(0.1 + 0.2)), row(None)];
        let text = to_json_lines(&rows).unwrap();
        assert_eq!(text.lines().count(), 2);
        assert_eq!(from_json_lines::<Sample>(&text).unwrap(), rows);
        let wrong = from_json_lines::<Sample>("{\"name\":3}").unwrap_err().to_string();
        assert!(wrong.contains("samples") && wrong.contains("expected a text in column name"), "{wrong}");
        assert!(from_json_lines::<Sample>("[1]").unwrap_err().to_string().contains("line 1"));
        assert_eq!((Sample::columns()[1].unit, Sample::columns()[1].may_be_empty), ("m", true));
    }
}
