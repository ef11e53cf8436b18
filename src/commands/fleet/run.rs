//! `mavid fleet SOURCE... --out DIR`: logs as tables.

use std::num::NonZero;

use super::limits::Bounds;
use super::settings::settings;
use super::work::{Tally, Work, failed};
use crate::cli::{FleetRunArgs, FormName};
use crate::commands::progress::Steps;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};
use mavid::fleet::{PartForm, PartsError, PartsFolder, Shard, sources};
use mavid::store::is_remote;
use mavid::text;

/// Names of variables that say which of several runs this one is, and of the first of them.
const INDEXES: [(&str, Option<&str>); 2] =
    [("JOB_COMPLETION_INDEX", None), ("SLURM_ARRAY_TASK_ID", Some("SLURM_ARRAY_TASK_MIN"))];

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FleetRunArgs) -> Result<Outcome, CommandError> {
    let Some(out) = &args.out else {
        return Err(CommandError::Input("expected --out DIR".to_owned()));
    };
    let is_here = !out.to_str().is_some_and(is_remote);
    if is_here && out.exists() && !out.is_dir() {
        return Err(CommandError::Input(format!("--out: expected a folder, {} is a file", text::path(out))));
    }
    let form = form(args.format)?;
    let shard = shard(args)?;
    let settings = settings(&args.study)?;
    let digest = settings.digest();
    let found = sources(&args.sources).map_err(|error| CommandError::Input(error.to_string()))?;
    let own: Vec<_> = found.into_iter().filter(|source| shard.has(&source.uri)).collect();
    if is_here {
        output::folder(out)?;
    }
    let folder = PartsFolder::open(out).map_err(failed)?;
    let lists = folder.lists().map_err(failed)?;
    if let Some(other) = lists.iter().find(|list| list.settings != digest) {
        return Err(failed(PartsError::OtherSettings { folder: folder.name(), part: other.part.clone() }));
    }
    folder.remove_unfinished(&lists, shard).map_err(failed)?;
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    let work = Work {
        folder: &folder,
        settings: &settings,
        digest: &digest,
        bounds: Bounds::of(&args.study),
        form,
        shard,
        jobs: args.jobs.map_or(cores, usize::from),
        part_logs: usize::try_from(args.part_logs).unwrap_or(1),
    };
    let tally = {
        let steps = Steps::new(stderr, "{bar:30} {pos} of {len} logs, about {eta} left");
        work.run(&own, &lists, &steps)?
    };
    if json {
        output::json(&tally)?;
    } else {
        output::text(&summary(&tally, &folder.name()))?;
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

fn summary(tally: &Tally, at: &str) -> String {
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
    page + &format!(
        "\n{rows} rows in {parts} new parts of each table: {at}\nwhich vehicles changed: mavid fleet report {at}"
    )
}
