//! Logs of ArduPilot among the other formats.

use crate::autopilot::DATAFLASH_MARKER;
use std::io::{BufReader, Read};

use super::damage::DataflashDamage;
use super::definition::{Definition, FMT, FMT_BYTES};
use super::definitions::Definitions;
use super::forms;
use super::message::Message;
use super::reader::DataflashReader;
use super::text_reader::DataflashTextReader;
use super::walk::{Messages, Walked, walk};
use crate::log::error::LogError;
use crate::log::format::{Certainty, Format, Sink};
use crate::log::input::Input;
use crate::log::loss::{Loss, Oddity};
use crate::log::onboard::OnboardReport;
use crate::log::options::OpenOptions;
use crate::log::report::{Details, ReadReport};

/// Binary logs.
pub(in crate::log) const BINARY: Format = Format {
    name: "ArduPilot log (.bin)",
    ending: "bin",
    takes_system: false,
    takes_columns: false,
    sniff: sniff_binary,
    read: read_binary,
    read_whole: None,
};

/// Text logs.
pub(in crate::log) const TEXT: Format = Format {
    name: "ArduPilot text log (.log)",
    ending: "log",
    takes_system: false,
    takes_columns: false,
    sniff: sniff_text,
    read: read_text,
    read_whole: None,
};

/// Definitions that are ArduPilot's but for damage. One could be of a log that only resembles; a log begins with tens
/// of them.
const LEAST_KNOWN: u32 = 3;
/// Lines of a text log among which the first definition is.
const FIRST_LINES: usize = 64;

/// Definitions, most of them padded as ArduPilot does. PX4's logs of before 2016 have spaces there.
fn sniff_binary(head: &[u8]) -> Option<Certainty> {
    let begins = |message: &&[u8]| {
        message[..2] == DATAFLASH_MARKER && message[2] == FMT && message[5].is_ascii_graphic()
    };
    let (mut sound, mut others, mut known) = (0, 0, 0);
    for message in head.windows(FMT_BYTES).filter(begins) {
        let is_sound = Definition::from_message(message).is_some();
        *(if is_sound { &mut sound } else { &mut others }) += 1;
        known += u32::from(forms::is_known(message));
    }
    // most are damaged, but some are those of no other autopilot
    (sound > others || known >= LEAST_KNOWN).then_some(Certainty::Certain)
}

/// A line that defines a message.
fn sniff_text(head: &[u8]) -> Option<Certainty> {
    let is_definition = |line: &[u8]| {
        let line = String::from_utf8_lossy(line);
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        matches!(cells[..], ["FMT", number, bytes, _, _, ..]
            if number.parse::<u8>().is_ok() && bytes.parse::<u8>().is_ok())
    };
    let mut lines = head.split(|byte| *byte == b'\n').take(FIRST_LINES);
    lines.any(is_definition).then_some(Certainty::Certain)
}

fn read_binary(input: &Input<'_>, _: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let mut reader = DataflashReader::new(input.open()?);
    let walked = walk(&mut reader, sink)?;
    Ok(report(BINARY.name, walked, reader.damage()))
}

fn read_text(input: &Input<'_>, _: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let mut reader = DataflashTextReader::new(BufReader::new(input.open()?));
    let mut walked = walk(&mut reader, sink)?;
    reader.preamble().iter().for_each(|line| walked.identity.text(line));
    Ok(report(TEXT.name, walked, reader.damage()))
}

impl<R: Read> Messages for DataflashReader<R> {
    fn next(&mut self) -> Result<Option<(Message<'_>, &Definitions)>, LogError> {
        self.next_with_definitions()
    }

    fn definitions(&self) -> &Definitions {
        self.definitions()
    }
}

impl<R: std::io::BufRead> Messages for DataflashTextReader<R> {
    fn next(&mut self) -> Result<Option<(Message<'_>, &Definitions)>, LogError> {
        self.next_with_definitions()
    }

    fn definitions(&self) -> &Definitions {
        self.definitions()
    }
}

fn report(format: &'static str, walked: Walked, damage: &DataflashDamage) -> ReadReport {
    let Walked { identity, tally, clock, dropped, date, .. } = walked;
    let oddities = [
        (dropped, Oddity::DroppedByVehicle { count: dropped }),
        (
            tally.without_time,
            Oddity::WithoutTime { count: tally.without_time, outputs: tally.outputs_without_time },
        ),
        (tally.unknown_unit, Oddity::UnknownUnit { count: tally.unknown_unit }),
        (
            clock.ran_back,
            Oddity::VehicleClockBack { count: clock.ran_back, most_us: clock.ran_back_most_us() },
        ),
    ];
    let mut losses = damage.losses();
    losses.extend((clock.strays > 0).then_some(Loss::StrayStamps { count: clock.strays }));
    ReadReport {
        format,
        losses,
        oddities: oddities.into_iter().filter_map(|(count, oddity)| (count > 0).then_some(oddity)).collect(),
        details: Details::Onboard(Box::new(OnboardReport {
            bytes: damage.bytes,
            messages: damage.messages,
            kind: identity.kind(),
            firmware: identity.firmware(),
            start_utc_us: date.began_us(),
            topics: tally.topics(),
        })),
        ..ReadReport::default()
    }
}
