//! `mavid convert LOG --to FORM`: the streams of a log for programs that plot.

use std::path::Path;

use mavid::convert::{TimeSeries, of_recording, of_study, to_csv};
use mavid::files::write_whole;
use mavid::log;
use mavid::study::{ExplainRequest, explain, unread};
use mavid::text;

use super::progress::Spinner;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::{ConvertArgs, ConvertForm};

/// What was written.
#[derive(Debug, serde::Serialize)]
struct Converted {
    schema: u32,
    files: Vec<String>,
    series: Vec<Listed>,
    losses: Vec<String>,
}

#[derive(Debug, serde::Serialize)]
struct Listed {
    name: String,
    unit: &'static str,
    columns: Vec<String>,
    samples: usize,
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &ConvertArgs) -> Result<Outcome, CommandError> {
    refuse_form(args.to)?;
    if args.out.exists() && !args.out.is_dir() {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            text::path(&args.out)
        )));
    }
    let options = args.read.settings().open_options()?;
    let opened = log::open(&args.log, &options).map_err(|error| unread(&args.log, error))?;
    let mut all = of_recording(&opened.recording);
    if let Some(vehicle) = args.given() {
        let request = ExplainRequest {
            logs: vec![args.log.clone()],
            vehicle,
            read: args.read.settings(),
            transient_s: ExplainRequest::TRANSIENT_S,
            ..ExplainRequest::default()
        };
        all.extend(of_study(&explain(&request, &Spinner::new(stderr))?));
    }
    output::folder(&args.out)?;
    let files = match args.to {
        ConvertForm::Csv => {
            each(&args.out, &all, "csv", &|series| to_csv(series).map_err(|error| error.to_string()))?
        }
        ConvertForm::Parquet => parquet(&args.out, &all)?,
        ConvertForm::Mcap => mcap(&args.out, &all, &opened)?,
    };
    let losses: Vec<String> = opened.report.losses.iter().map(ToString::to_string).collect();
    let outcome = if losses.is_empty() { Outcome::Done } else { Outcome::DoneWithLoss };
    let listed = all.into_iter().map(|series| Listed {
        samples: series.time_s.len(),
        name: series.name,
        unit: series.unit,
        columns: series.columns,
    });
    let converted = Converted { schema: 1, files, series: listed.collect(), losses };
    if json { output::json(&converted) } else { output::text(&summary(&converted, &args.out)) }?;
    Ok(outcome)
}

#[cfg(feature = "fleet")]
fn refuse_form(_: ConvertForm) -> Result<(), CommandError> {
    Ok(())
}

#[cfg(not(feature = "fleet"))]
fn refuse_form(form: ConvertForm) -> Result<(), CommandError> {
    if form == ConvertForm::Csv {
        return Ok(());
    }
    Err(CommandError::Input(
        "--to mcap and --to parquet: this program was built without them; build it with `cargo build --release --features fleet`, or \
         take --to csv"
            .to_owned(),
    ))
}

fn summary(converted: &Converted, out: &Path) -> String {
    let mut page = format!("{} files in {}\n", converted.files.len(), text::path(&out));
    for Listed { name, unit, columns, samples } in &converted.series {
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        page.push_str(&format!("  {name}: {}{unit}, {samples} samples\n", columns.join(", ")));
    }
    for loss in &converted.losses {
        page.push_str(&format!("not read of the log: {loss}\n"));
    }
    page.trim_end().to_owned()
}

/// A file for each series.
fn each(
    out: &Path,
    all: &[TimeSeries],
    ending: &str,
    bytes: &dyn Fn(&TimeSeries) -> Result<Vec<u8>, String>,
) -> Result<Vec<String>, CommandError> {
    let one = |series: &TimeSeries| {
        let name = format!("{}.{ending}", series.file_name());
        write(out, name, &bytes(series).map_err(CommandError::Failure)?)
    };
    all.iter().map(one).collect()
}

fn write(out: &Path, name: String, bytes: &[u8]) -> Result<String, CommandError> {
    let path = out.join(&name);
    write_whole(&path, bytes)
        .map_err(|error| CommandError::Input(format!("cannot write {}: {error}", text::path(&path))))?;
    Ok(name)
}

#[cfg(feature = "fleet")]
fn parquet(out: &Path, all: &[TimeSeries]) -> Result<Vec<String>, CommandError> {
    let bytes =
        |series: &TimeSeries| mavid::convert::series_to_parquet(series).map_err(|error| error.to_string());
    each(out, all, "parquet", &bytes)
}

#[cfg(feature = "fleet")]
fn mcap(out: &Path, all: &[TimeSeries], opened: &log::Opened) -> Result<Vec<String>, CommandError> {
    use mavid::convert::{foxglove_layout, plotjuggler_layout, to_mcap};
    let start_us = opened.report.telemetry().and_then(|report| report.first_stamp_us).unwrap_or(0);
    let bytes = to_mcap(all, &opened.recording.texts, start_us.saturating_mul(1000))
        .map_err(|error| CommandError::Failure(error.to_string()))?;
    Ok(vec![
        write(out, "flight.mcap".to_owned(), &bytes)?,
        write(out, "foxglove-layout.json".to_owned(), foxglove_layout(all).as_bytes())?,
        write(out, "plotjuggler-layout.xml".to_owned(), plotjuggler_layout(all).as_bytes())?,
    ])
}

#[cfg(not(feature = "fleet"))]
fn parquet(_: &Path, _: &[TimeSeries]) -> Result<Vec<String>, CommandError> {
    refuse_form(ConvertForm::Parquet).map(|()| Vec::new())
}

#[cfg(not(feature = "fleet"))]
fn mcap(_: &Path, _: &[TimeSeries], _: &log::Opened) -> Result<Vec<String>, CommandError> {
    refuse_form(ConvertForm::Mcap).map(|()| Vec::new())
}
