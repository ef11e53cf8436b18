//! Tables as Parquet: units and meanings are in the metadata of the fields, the version in that of the file.

use std::collections::HashMap;
use std::sync::Arc;

use super::cell::Cell;
use super::column::{Column, Kind};
use super::rows::{Row, TableError};
use arrow_array::builder::{BooleanBuilder, Float64Builder, Int64Builder, ListBuilder, StringBuilder};
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;

/// Metadata of a field: its unit, and what it is.
const UNIT: &str = "unit";
const MEANING: &str = "meaning";
/// Metadata of a file: version of its tables.
const VERSION: &str = "mavid.schema";

fn data_type(kind: Kind) -> DataType {
    match kind {
        Kind::Text => DataType::Utf8,
        Kind::Number => DataType::Float64,
        Kind::Whole => DataType::Int64,
        Kind::Truth => DataType::Boolean,
        Kind::Numbers => DataType::List(Arc::new(Field::new("item", DataType::Float64, true))),
    }
}

fn field(column: &Column) -> Field {
    let told = [(UNIT, column.unit), (MEANING, column.words)];
    let metadata: HashMap<String, String> =
        told.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
    Field::new(column.name, data_type(column.kind), true).with_metadata(metadata)
}

/// The rows as a file. The same rows give the same bytes.
///
/// # Errors
/// [`TableError::File`] where they cannot be written.
pub fn to_parquet<R: Row>(rows: &[R], version: i64) -> Result<Vec<u8>, TableError> {
    let columns = R::columns();
    let mut cells: Vec<Vec<Cell>> = vec![Vec::with_capacity(rows.len()); columns.len()];
    for row in rows {
        cells.iter_mut().zip(row.cells()).for_each(|(column, cell)| column.push(cell));
    }
    let metadata = HashMap::from([(VERSION.to_owned(), version.to_string())]);
    let fields: Vec<Field> = columns.iter().map(field).collect();
    let schema = Arc::new(Schema::new_with_metadata(fields, metadata));
    let arrays: Vec<ArrayRef> =
        columns.iter().zip(&cells).map(|(column, cells)| array(column.kind, cells)).collect();
    let failed = |why: String| TableError::File { table: R::TABLE, why };
    let batch =
        RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(|error| failed(error.to_string()))?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, Some(properties))
        .map_err(|error| failed(error.to_string()))?;
    writer.write(&batch).map_err(|error| failed(error.to_string()))?;
    writer.into_inner().map_err(|error| failed(error.to_string()))
}

fn array(kind: Kind, cells: &[Cell]) -> ArrayRef {
    match kind {
        Kind::Text => {
            let mut out = StringBuilder::new();
            cells.iter().for_each(|cell| {
                out.append_option(if let Cell::Text(text) = cell { Some(text) } else { None });
            });
            Arc::new(out.finish())
        }
        Kind::Number => {
            let mut out = Float64Builder::new();
            cells.iter().for_each(|cell| {
                out.append_option(if let Cell::Number(number) = cell { finite(*number) } else { None });
            });
            Arc::new(out.finish())
        }
        Kind::Whole => {
            let mut out = Int64Builder::new();
            cells.iter().for_each(|cell| {
                out.append_option(if let Cell::Whole(whole) = cell { Some(*whole) } else { None })
            });
            Arc::new(out.finish())
        }
        Kind::Truth => {
            let mut out = BooleanBuilder::new();
            cells.iter().for_each(|cell| {
                out.append_option(if let Cell::Truth(truth) = cell { Some(*truth) } else { None })
            });
            Arc::new(out.finish())
        }
        Kind::Numbers => {
            let mut out = ListBuilder::new(Float64Builder::new());
            for cell in cells {
                if let Cell::Numbers(numbers) = cell {
                    numbers.iter().for_each(|number| out.values().append_option(finite(*number)));
                }
                out.append(matches!(cell, Cell::Numbers(_)));
            }
            Arc::new(out.finish())
        }
    }
}

/// As in the other form of tables.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// The rows of a file. Columns that are not known are left out; one that is missing is empty.
///
/// # Errors
/// [`TableError`] where it is no Parquet, is damaged, or a column holds another kind.
pub fn from_parquet<R: Row>(bytes: Vec<u8>) -> Result<Vec<R>, TableError> {
    let failed = |why: String| TableError::File { table: R::TABLE, why };
    let columns = R::columns();
    let reader = ParquetRecordBatchReaderBuilder::try_new(bytes::Bytes::from(bytes))
        .and_then(ParquetRecordBatchReaderBuilder::build)
        .map_err(|error| failed(error.to_string()))?;
    let mut rows = Vec::new();
    for batch in reader {
        let batch = batch.map_err(|error| failed(error.to_string()))?;
        let arrays: Vec<Option<&ArrayRef>> =
            columns.iter().map(|column| batch.column_by_name(column.name)).collect();
        for row in 0..batch.num_rows() {
            let of = |(column, array): (&Column, &Option<&ArrayRef>)| {
                array.map_or(Cell::Empty, |array| cell(array, column.kind, row))
            };
            rows.push(R::of_cells(columns.iter().zip(&arrays).map(of).collect())?);
        }
    }
    Ok(rows)
}

fn cell(array: &ArrayRef, kind: Kind, row: usize) -> Cell {
    if array.is_null(row) {
        return Cell::Empty;
    }
    let found = match kind {
        Kind::Text => array.as_string_opt::<i32>().map(|array| Cell::Text(array.value(row).to_owned())),
        Kind::Number => array.as_primitive_opt::<Float64Type>().map(|array| Cell::Number(array.value(row))),
        Kind::Whole => array.as_primitive_opt::<Int64Type>().map(|array| Cell::Whole(array.value(row))),
        Kind::Truth => array.as_boolean_opt().map(|array| Cell::Truth(array.value(row))),
        Kind::Numbers => array.as_list_opt::<i32>().and_then(|array| {
            let items = array.value(row);
            let items = items.as_primitive_opt::<Float64Type>()?;
            let item = |place| if items.is_null(place) { f64::NAN } else { items.value(place) };
            Some(Cell::Numbers((0..items.len()).map(item).collect()))
        }),
    };
    found.unwrap_or(Cell::Empty)
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::table_rows! {
        Sample, "samples", "a sample" {
            name: Option<String>, "", "its name";
            value: f64, "m", "how long it is";
            count: Option<i64>, "1", "how many there are";
            is_good: bool, "", "whether it is good";
            series: Vec<f64>, "N", "what was measured";
        }
    }

    #[test]
    fn rows_read_back_are_the_same_and_the_same_rows_give_the_same_bytes() {
        let rows = vec![
            Sample {
                name: Some("a".to_owned()),
                value: 0.1,
                count: None,
                is_good: true,
                series: vec![1.0, 2.0],
            },
            Sample { name: None, value: -1e-300, count: Some(7), is_good: false, series: Vec::new() },
        ];
        let bytes = to_parquet(&rows, 3).unwrap();
        assert_eq!(bytes, to_parquet(&rows, 3).unwrap());
        assert_eq!(from_parquet::<Sample>(bytes.clone()).unwrap(), rows);
        let reader = ParquetRecordBatchReaderBuilder::try_new(bytes::Bytes::from(bytes)).unwrap();
        let schema = reader.schema();
        assert_eq!(schema.field(1).metadata()[UNIT], "m");
        assert_eq!(schema.metadata()[VERSION], "3");
        assert!(from_parquet::<Sample>(vec![1, 2, 3]).is_err());
        assert_eq!(from_parquet::<Sample>(to_parquet::<Sample>(&[], 3).unwrap()).unwrap(), []);
    }
}
