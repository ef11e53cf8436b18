//! Arguments of `mavid csv-map`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `mavid csv-map`.
#[derive(Debug, Args)]
pub struct CsvMapArgs {
    /// the table: a .csv with one row of names
    #[arg(value_name = "FILE.CSV")]
    pub table: PathBuf,
    /// write the mapping here; without it it is printed
    #[arg(long, value_name = "MAP.TOML")]
    pub out: Option<PathBuf>,
}
