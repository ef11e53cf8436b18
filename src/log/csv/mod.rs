//! Flights as tables of comma-separated values: any columns, with a mapping that says what they mean.
//!
//! Rows stream through; what is wrong with one is counted and told, and the rest is kept.

mod bounded;
mod convert;
mod error;
mod mapping;
mod reader;
mod report;
mod rows;

pub use error::CsvError;
pub use mapping::{AttitudeForm, AxisFrame, CsvMapping, CsvQuantity, CsvTime, CsvUnit, column_count};
pub use reader::{read_csv, read_csv_from};
pub use report::{CsvReport, RowRejection};
