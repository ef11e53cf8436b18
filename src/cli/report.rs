//! Arguments of `mavid report`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `mavid report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// folder that `run`, `demo`, `fly`, `explain --out` or `compare --out` wrote
    #[arg(value_name = "PATH")]
    pub path: PathBuf,
    /// form of the report
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = ReportFormat::Md, conflicts_with = "json")]
    pub format: ReportFormat,
}

/// Form of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ReportFormat {
    /// a summary in Markdown, to paste into a forum or an issue
    Md,
    /// for a terminal
    Text,
    /// the document that the command writes with --json
    Json,
    /// the page; on a terminal the place of its file
    Html,
}
