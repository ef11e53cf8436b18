//! The one door: a file of any known format becomes a recording. What it is, its content tells, never its name.

use std::path::Path;

use super::error::LogError;
use super::flights::{Cells, Flights, Hold, Plan, is_state};
use super::foreign::{archive, foreign};
use super::format::{Certainty, Format, Sink};
use super::input::Input;
use super::loss::Loss;
use super::options::OpenOptions;
use super::report::ReadReport;
use super::{csv, dataflash, tlog, ulog};
use crate::recording::{Event, Recording, RecordingBuilder};

/// All formats that are read. Their order means nothing.
pub const FORMATS: &[&Format] =
    &[&tlog::FORMAT, &ulog::FORMAT, &dataflash::BINARY, &dataflash::TEXT, &csv::FORMAT];

/// Whether a file is named like a log of one of the formats, whatever the case: so logs are found in a folder.
#[must_use]
pub fn is_named_like_a_log(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    FORMATS.iter().any(|format| format.ending.eq_ignore_ascii_case(ending))
}

/// A log in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Opened {
    /// the flight
    pub recording: Recording,
    /// what was met while reading it
    pub report: ReadReport,
}

/// Reads a log into memory, all of it. Of several vehicles, the one that flew is read, unless `options` choose one.
///
/// ```
/// use mavid::log::{self, OpenOptions};
/// use mavid::recording::Quantity;
/// use std::path::Path;
///
/// let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/p04_identify_10_22s.tlog");
/// let log = log::open(&path, &OpenOptions::default())?;
/// let attitude = log.recording.streams.iter().find(|(key, _)| key.quantity == Quantity::Attitude);
/// assert!(attitude.is_some_and(|(_, stream)| stream.len() > 100));
/// assert!(log.report.losses.is_empty());
/// # Ok::<(), mavid::log::LogError>(())
/// ```
///
/// # Errors
/// The file cannot be read, is of no known format, holds no vehicle, or several that flew.
pub fn open<'a>(log: impl Into<Input<'a>>, options: &OpenOptions) -> Result<Opened, LogError> {
    let input = log.into();
    let format = format_of(input)?;
    let _stage = stage(&input, format).entered();
    let (mut report, builder) = of_the_flown(options, |options| {
        let mut builder = RecordingBuilder::new();
        let report = match format.read_whole {
            Some(read_whole) => read_whole(&input, options, &mut builder)?,
            None => (format.read)(&input, options, &mut |_, event| builder.add(event))?,
        };
        Ok((report, builder))
    })?;
    let (mut recording, repairs) = builder.finish();
    report.repaired(repairs);
    report.leave_out_leaps(&mut recording);
    emit_losses(&report);
    Ok(Opened { recording, report })
}

/// The flights of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenedFlights {
    /// the flights
    pub flights: Flights,
    /// what was met while reading the log
    pub report: ReadReport,
}

/// Reads a log's flights into memory that does not grow with its length, at most `most`: see [`Flights::of`]. Of several
/// vehicles, the one that flew is read, unless `options` choose one.
///
/// # Errors
/// As [`open`].
pub fn open_flights<'a>(
    log: impl Into<Input<'a>>,
    options: &OpenOptions,
    most: &Hold,
) -> Result<OpenedFlights, LogError> {
    let input = log.into();
    let format = format_of(input)?;
    let _stage = stage(&input, format).entered();
    let (mut report, (cells, builder)) = of_the_flown(options, |options| {
        let mut cells = Cells::default();
        let mut builder = Some(RecordingBuilder::new());
        let report = (format.read)(&input, options, &mut |_, event| {
            cells.add(&event);
            // too much to be held: what is kept of it is read once more
            if builder.as_ref().is_some_and(|builder| builder.numbers() > most.numbers) {
                builder = None;
            }
            if let Some(builder) = &mut builder {
                builder.add(event);
            }
        })?;
        Ok((report, (cells, builder)))
    })?;
    let plan = cells.plan(most);
    let builder = match builder {
        Some(builder) => builder,
        // without a plan it fits in, but for what stands empty where a stream grows wider
        None => {
            let system = report.vehicle.map(|vehicle| vehicle.system).or(options.system);
            within(format, &input, &OpenOptions { system, ..options.clone() }, plan.as_ref())?
        }
    };
    let (mut recording, repairs) = builder.finish();
    report.repaired(repairs);
    report.leave_out_leaps(&mut recording);
    let flights = Flights::by_plan(recording, plan.as_ref());
    if flights.left_out_s > 0.0 {
        report.losses.push(Loss::NotHeld { seconds: flights.left_out_s });
    }
    emit_losses(&report);
    Ok(OpenedFlights { flights, report })
}

/// Reads a log, giving each piece of the flight to `sink` as it comes; memory does not grow with the log.
///
/// # Errors
/// As [`open`], and [`LogError::OtherFlew`] where a vehicle flew that is not the first of the log: what was given is of
/// the first. With that vehicle's system in `options` it is read.
pub fn stream<'a>(
    log: impl Into<Input<'a>>,
    options: &OpenOptions,
    sink: &mut Sink<'_>,
) -> Result<ReadReport, LogError> {
    let input = log.into();
    let format = format_of(input)?;
    let _stage = stage(&input, format).entered();
    let report = (format.read)(&input, options, sink)?;
    emit_losses(&report);
    Ok(report)
}

/// The reading of a log as a stage of the trace.
fn stage(input: &Input<'_>, format: &Format) -> tracing::Span {
    tracing::info_span!("read", path = input.name(), format = format.name)
}

/// Each loss as an event of the trace.
fn emit_losses(report: &ReadReport) {
    for loss in &report.losses {
        tracing::info!(%loss, "data lost");
    }
}

/// Refuses a path that leads to no file: to a folder, or to what can be read only once; and a pattern. That there is nothing at all is
/// told by who opens it.
///
/// # Errors
/// It leads to such a thing.
pub fn expect_file<'a>(log: impl Into<Input<'a>>) -> Result<(), LogError> {
    log.into().no_file().map_or(Ok(()), |(came, advice)| Err(unknown(came, advice)))
}

/// The format that a log's first bytes are of.
///
/// # Errors
/// The file cannot be read, or is of no known format.
pub fn format_of<'a>(log: impl Into<Input<'a>>) -> Result<&'static Format, LogError> {
    let input = log.into();
    expect_file(input)?;
    let head = input.head()?;
    // one that stores what it holds as it is would pass for it
    if let Some(archive) = archive(&head) {
        return Err(unknown(archive.what, archive.advice));
    }
    let found = FORMATS.iter().filter_map(|format| Some(((format.sniff)(&head)?, *format)));
    match found.max_by_key(|(certainty, _)| *certainty) {
        Some((Certainty::Certain, format)) => Ok(format),
        likely => match (foreign(&head), likely) {
            (Some(known), _) => Err(unknown(known.what, known.advice)),
            (None, Some((_, format))) => Ok(format),
            (None, None) => {
                let (what, advice) = super::foreign::otherwise(&head);
                Err(unknown(&what, advice))
            }
        },
    }
}

fn unknown(came: &str, advice: &'static str) -> LogError {
    let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
    let expected = match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => names.join(""),
    };
    LogError::UnknownFormat { expected, came: came.to_owned(), advice }
}

/// Reads a log; where it holds several vehicles and none is chosen, the one that flew.
fn of_the_flown<T>(
    options: &OpenOptions,
    read: impl Fn(&OpenOptions) -> Result<(ReadReport, T), LogError>,
) -> Result<(ReadReport, T), LogError> {
    match read(options) {
        Err(LogError::OtherFlew { system }) if options.system.is_none() => {
            read(&OpenOptions { system: Some(system), ..options.clone() })
        }
        found => found,
    }
}

/// What a log holds in the spans that are kept; all of it without a plan.
fn within(
    format: &Format,
    input: &Input<'_>,
    options: &OpenOptions,
    plan: Option<&Plan>,
) -> Result<RecordingBuilder, LogError> {
    let mut builder = RecordingBuilder::new();
    let keeps = |time_s: f64| plan.is_none_or(|plan| plan.keeps(time_s));
    let kept = |event: &Event<'_>| match event {
        Event::Sample { stream, time_s, .. } => is_state(stream.quantity) || keeps(*time_s),
        Event::Text { time_s, .. } => keeps(*time_s),
        Event::Autopilot(_)
        | Event::Parameter { .. }
        | Event::ParameterDefault { .. }
        | Event::ClockReset { .. }
        | Event::EstimatorReset { .. } => true,
    };
    (format.read)(input, options, &mut |_, event| {
        if kept(&event) {
            builder.add(event);
        }
    })?;
    Ok(builder)
}
