//! The run of `mavid inspect`: a log is read, and what it holds is printed.

use std::path::Path;

use mavid::config::{default_csv_mapping, load_csv_mapping, read_vehicle};
use mavid::inspect::{Inspection, inspect_csv, inspect_tlog};
use mavid::log::LoadOptions;
use mavid::log::csv::read_csv;
use mavid::report::{InspectionDocument, inspection_text};
use mavid::text;
use mavid::vehicle::Vehicle;
use mavid::wire::SystemId;

use super::progress;
use crate::cli::InspectArgs;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &InspectArgs) -> Result<Outcome, CommandError> {
    let loaded = args.vehicle.as_deref().map(read_vehicle).transpose()?;
    if let (Some(path), Some(loaded)) = (&args.vehicle, &loaded) {
        output::warnings(path, &loaded.warnings);
    }
    let vehicle = loaded.as_ref().map(|loaded| &loaded.vehicle);
    let inspection = inspect(stderr, args, vehicle)?;
    let file = text::path(&args.log);
    if json {
        output::json(&InspectionDocument::new(&file, &inspection))?;
    } else {
        output::text(&inspection_text(&file, &inspection))?;
    }
    Ok(if inspection.losses.is_empty() { Outcome::Done } else { Outcome::DoneWithLoss })
}

fn inspect(
    stderr: &StandardError,
    args: &InspectArgs,
    vehicle: Option<&Vehicle>,
) -> Result<Inspection, CommandError> {
    let path = args.log.as_path();
    if path.is_dir() {
        let text = format!("expected a log (*.tlog, *.csv), got the folder {}", text::path(&path));
        return Err(CommandError::Input(text));
    }
    let is = |wanted: &str| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted));
    if is("csv") {
        return csv(path, args, vehicle);
    }
    if !is("tlog") {
        let text = format!("expected a log named *.tlog or *.csv, got {}", text::path(&path));
        return Err(CommandError::Input(text));
    }
    if args.read.csv_map.is_some() {
        return Err(CommandError::Input("--csv-map is for *.csv logs; this one is a *.tlog".into()));
    }
    let options = LoadOptions { system: args.read.system.map(SystemId) };
    let bar = stderr.bar(progress::of_file(path));
    let inspection = inspect_tlog(path, &options, vehicle, &mut |bytes| bar.set_position(bytes));
    bar.finish_and_clear();
    inspection.map_err(|error| CommandError::Input(named(path, &error.to_string())))
}

fn csv(path: &Path, args: &InspectArgs, vehicle: Option<&Vehicle>) -> Result<Inspection, CommandError> {
    if args.read.system.is_some() {
        return Err(CommandError::Input("--system-id is for *.tlog logs; this one is a *.csv".into()));
    }
    let mapping = match &args.read.csv_map {
        Some(file) => load_csv_mapping(file)?,
        None => default_csv_mapping()?,
    };
    let (recording, report) = read_csv(path, &mapping)?;
    Ok(inspect_csv(&recording, &report, vehicle))
}

/// The message with the file's name, where it has none.
fn named(path: &Path, message: &str) -> String {
    let name = text::path(&path);
    if message.contains(&name) { message.to_owned() } else { format!("{name}: {message}") }
}
