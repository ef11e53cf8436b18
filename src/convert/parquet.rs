//! A series as Parquet.

use std::collections::HashMap;
use std::sync::Arc;

use super::series::TimeSeries;
use crate::table::TableError;
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::properties::WriterProperties;

/// A series as a file: `time_s` and a column for each value, with units in the metadata of the fields.
///
/// # Errors
/// [`TableError::File`] where it cannot be written.
pub fn series_to_parquet(series: &TimeSeries) -> Result<Vec<u8>, TableError> {
    let failed = |why: String| TableError::File { table: "series", why };
    let field = |name: &str, unit: &str| {
        let metadata = HashMap::from([("unit".to_owned(), unit.to_owned())]);
        Field::new(name, DataType::Float64, true).with_metadata(metadata)
    };
    let mut fields = vec![field("time_s", "s")];
    fields.extend(series.columns.iter().map(|name| field(name, series.unit)));
    let schema = Arc::new(Schema::new(fields));
    let column = |of: &dyn Fn(usize) -> f64| -> ArrayRef {
        let finite = |value: f64| value.is_finite().then_some(value);
        Arc::new((0..series.time_s.len()).map(|index| finite(of(index))).collect::<Float64Array>())
    };
    let mut arrays = vec![column(&|index| series.time_s[index])];
    arrays.extend(
        (0..series.columns.len())
            .map(|place| column(&|index| series.sample(index).get(place).copied().unwrap_or(f64::NAN))),
    );
    let batch =
        RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(|error| failed(error.to_string()))?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = ArrowWriter::try_new(Vec::new(), schema, Some(properties))
        .map_err(|error| failed(error.to_string()))?;
    writer.write(&batch).map_err(|error| failed(error.to_string()))?;
    writer.into_inner().map_err(|error| failed(error.to_string()))
}
