//! Telemetry logs among the other formats.

use super::flown::who_flew;
use super::reader::TlogReader;
use super::walk::{Walk, walk};
use crate::log::error::LogError;
use crate::log::format::{Certainty, Format, Sink};
use crate::log::input::Input;
use crate::log::options::OpenOptions;
use crate::log::report::{Details, ReadReport};

/// Telemetry logs.
pub(in crate::log) const FORMAT: Format = Format {
    name: "telemetry log (.tlog)",
    ending: "tlog",
    takes_system: true,
    takes_columns: false,
    sniff,
    read,
    read_whole: None,
};

/// A record: a stamp, and a frame whose checksum is right.
fn sniff(head: &[u8]) -> Option<Certainty> {
    let is_record = matches!(TlogReader::new(head).next_record(), Ok(Some(_)));
    is_record.then_some(Certainty::Certain)
}

fn read(input: &Input<'_>, options: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let Walk { vehicle, vehicles, report } = walk(input, options.system, sink)?;
    if options.system.is_none() && vehicles.len() > 1 {
        let system = who_flew(input)?;
        if system != vehicle.system {
            return Err(LogError::OtherFlew { system });
        }
    }
    Ok(ReadReport {
        format: FORMAT.name,
        vehicle: Some(vehicle),
        others: vehicles.into_iter().filter(|system| *system != vehicle.system).collect(),
        losses: report.losses(),
        oddities: report.oddities(),
        details: Details::Telemetry(Box::new(report)),
        ..ReadReport::default()
    })
}
