//! Tables among the other formats.

use std::io::BufReader;

use super::reader::read_table;
use super::table::{no_text, without_mark};
use crate::log::error::LogError;
use crate::log::format::{Certainty, Format, Sink};
use crate::log::input::Input;
use crate::log::options::OpenOptions;
use crate::log::report::{Details, ReadReport};

/// Tables.
pub(in crate::log) const FORMAT: Format = Format {
    name: "table of comma-separated values (.csv)",
    ending: "csv",
    takes_system: false,
    takes_columns: true,
    sniff,
    read,
    read_whole: None,
};

/// What may stand between cells, whatever the mapping says.
const DELIMITERS: &[u8] = b",;\t|";

/// Text whose first line has more than one cell and is not numbers only. Much other text looks the same.
fn sniff(head: &[u8]) -> Option<Certainty> {
    let line = without_mark(head.split_inclusive(|byte| *byte == b'\n').next().unwrap_or_default());
    let cells = || line.split(|byte| DELIMITERS.contains(byte)).map(<[u8]>::trim_ascii);
    let is_number = |cell: &[u8]| String::from_utf8_lossy(cell).parse::<f64>().is_ok();
    let is_name = |cell: &[u8]| !cell.is_empty() && !is_number(cell);
    let is_header = no_text(line).is_none() && cells().count() > 1 && cells().any(is_name);
    is_header.then_some(Certainty::Possible)
}

fn read(input: &Input<'_>, options: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let from = BufReader::new(input.open()?);
    let report = read_table(from, &input.name(), &options.columns, sink)?;
    Ok(ReadReport {
        format: FORMAT.name,
        losses: report.losses(),
        details: Details::Table(report),
        ..ReadReport::default()
    })
}
