//! Flights as tables of comma-separated values: any columns, with a mapping that says what they mean.
//!
//! Rows stream through; what is wrong with one is counted and told, and the rest is kept.

mod bounded;
mod columns;
mod convert;
mod error;
mod format;
mod head;
mod mapping;
mod outlet;
mod reader;
mod report;
mod rows;
mod table;

pub use error::CsvError;
pub(super) use format::FORMAT;
pub use head::{TableHead, read_head};
pub use mapping::{AttitudeForm, AxisFrame, CsvMapping, CsvQuantity, CsvTime, CsvUnit, column_count};
pub use reader::read_table;
pub use report::CsvReport;
