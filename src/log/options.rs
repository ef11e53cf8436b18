//! What to read from a log.

use super::csv::CsvMapping;
use crate::wire::SystemId;

/// What to read from a log. Each format uses what it needs of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OpenOptions {
    /// the vehicle, where a log may hold several; without it the one that flew
    pub system: Option<SystemId>,
    /// what the columns of a table mean; the default is the mapping of `configs/csv/default.toml`
    pub columns: CsvMapping,
}
