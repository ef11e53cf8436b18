//! `mavid fleet SOURCE... --out DIR`: logs as tables.

use std::num::NonZero;
use std::path::PathBuf;

use super::limits::Limits;
use super::work::{Tally, Work, failed, hash};
use crate::cli::{FleetRunArgs, FormName};
use crate::commands::progress::Steps;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};
use mavid::config::load_csv_mapping;
use mavid::fleet::{LogSettings, PartForm, PartsError, PartsFolder, Shard, Vehicles, sources};
use mavid::text;

/// Names of variables that say which of several runs this one is, and of the first of them.
const INDEXES: [(&str, Option<&str>); 2] =
    [("JOB_COMPLETION_INDEX", None), ("SLURM_ARRAY_TASK_ID", Some("SLURM_ARRAY_TASK_MIN"))];

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FleetRunArgs) -> Result<Outcome, CommandError> {
    let Some(out) = &args.out else {
        return Err(CommandError::Input("expected --out DIR".to_owned()));
    };
    if out.exists() && !out.is_dir() {
        return Err(CommandError::Input(format!("--out: expected a folder, {} is a file", text::path(out))));
    }
    let form = form(args.format)?;
    let shard = shard(args)?;
    let settings = settings(args)?;
    let digest = settings.digest();
    let found = sources(&args.sources).map_err(|error| CommandError::Input(error.to_string()))?;
    let own: Vec<_> = found.into_iter().filter(|source| shard.has(&source.uri)).collect();
    output::folder(out)?;
    let folder = PartsFolder::new(out);
    let lists = folder.lists().map_err(failed)?;
    if let Some(other) = lists.iter().find(|list| list.settings != digest) {
        let (path, part) = (out.clone(), other.part.clone());
        return Err(failed(PartsError::OtherSettings { path, part }));
    }
    folder.remove_unfinished(&lists, shard).map_err(failed)?;
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let work = Work {
        folder: &folder,
        settings: &settings,
        digest: &digest,
        limits: Limits { time_s: args.log_time, memory_mb: args.log_memory },
        form,
        shard,
        jobs: args.jobs.map_or(cores, usize::from),
        part_logs: usize::try_from(args.part_logs).unwrap_or(1),
        most_bytes: args.log_size.saturating_mul(1 << 20),
    };
    let tally = {
        let steps = Steps::new(stderr, "{bar:30} {pos} of {len} logs, {eta} left");
        work.run(&own, &lists, &steps)?
    };
    if json {
        output::json(&tally)?;
    } else {
        output::text(&summary(&tally, out))?;
    }
    Ok(if tally.errors == 0 { Outcome::Done } else { Outcome::DoneWithLoss })
}

fn form(asked: Option<FormName>) -> Result<PartForm, CommandError> {
    match asked {
        None => Ok(PartForm::USUAL),
        Some(FormName::Jsonl) => Ok(PartForm::Jsonl),
        #[cfg(feature = "fleet")]
        Some(FormName::Parquet) => Ok(PartForm::Parquet),
        #[cfg(not(feature = "fleet"))]
        Some(FormName::Parquet) => Err(CommandError::Input(
            "--format parquet: this program was built without it; build it with `cargo build --release --features fleet`, or take \
             --format jsonl, which has the same rows"
                .to_owned(),
        )),
    }
}

/// What is asked for, or what the scheduler of this run says.
fn shard(args: &FleetRunArgs) -> Result<Shard, CommandError> {
    let Some(count) = args.shards else { return Ok(args.shard.unwrap_or(Shard::WHOLE)) };
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.trim().parse::<u32>().ok());
    let found = INDEXES.iter().find_map(|(name, first)| Some((*name, number(name)?, first.and_then(number))));
    let Some((name, index, first)) = found else {
        let names = INDEXES.map(|(name, _)| name).join(" or ");
        return Err(CommandError::Input(format!("--shards: expected a number in {names}, got none")));
    };
    let index = index.saturating_sub(first.unwrap_or(0));
    Shard::new(index, count).map_err(|why| CommandError::Input(format!("--shards {count}, {name}: {why}")))
}

/// All that the rows depend on beside the logs.
fn settings(args: &FleetRunArgs) -> Result<LogSettings, CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let vehicles = args.vehicles.as_deref().map(Vehicles::read).transpose().map_err(|error| input(&error))?;
    let vehicles = vehicles.unwrap_or_default();
    args.csv_map.as_deref().map(load_csv_mapping).transpose()?;
    let named: Vec<&PathBuf> =
        vehicles.vehicle.iter().filter_map(|vehicle| vehicle.file.as_ref()).chain(&args.csv_map).collect();
    for vehicle in vehicles.vehicle.iter().filter_map(|vehicle| vehicle.file.as_deref()) {
        // one that cannot be read is told before the work
        mavid::config::read_vehicle(vehicle)?;
    }
    let files =
        named.iter().map(|path| hash(path)).collect::<Result<_, _>>().map_err(|error| input(&error))?;
    Ok(LogSettings { depth: args.depth.into(), vehicles, csv_map: args.csv_map.clone(), files })
}

fn summary(tally: &Tally, out: &std::path::Path) -> String {
    let Tally { logs, done_before, twins, flown, no_flight, inspected, errors, rows, parts } = tally;
    let mut page = format!(
        "{logs} logs: {flown} with a flight, {no_flight} without one that can be used, {errors} that could not be read"
    );
    if *inspected > 0 {
        page.push_str(&format!("; {inspected} were inspected, and not asked for flights"));
    }
    if *done_before > 0 {
        page.push_str(&format!("; {done_before} are in the tables from before"));
    }
    if *twins > 0 {
        page.push_str(&format!("; {twins} are the same bytes as another"));
    }
    let at = text::path(&out);
    page + &format!(
        "\n{rows} rows in {parts} new parts of each table: {at}\nwhich vehicles changed: mavid fleet report {at}"
    )
}
