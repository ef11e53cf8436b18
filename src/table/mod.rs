//! Tables of typed rows: each column has a name, a kind, a unit and a sentence, and a table is written as JSON lines or as Parquet.
//!
//! A row is a struct that [`crate::table_rows!`] declares, with one field a column.

mod cell;
mod column;
mod json;
#[cfg(feature = "fleet")]
mod parquet;
mod rows;

pub use cell::{Cell, Field};
pub use column::{Column, Kind};
pub use json::{from_json_lines, to_json_lines, to_values};
#[cfg(feature = "fleet")]
pub use parquet::{from_parquet, to_parquet};
pub use rows::{Row, TableError};
