//! The process that studies one log: the task on standard input, the rows on standard output. It is not for people.

use std::io::Read;

use super::limits::Limits;
use crate::cli::FleetLogArgs;
use crate::commands::{CommandError, Outcome, output};
use mavid::fleet::{LogTask, log_rows, rows_text};

/// Most bytes of a task.
const MOST_TASK: u64 = 64 << 20;

/// Runs the verb.
pub fn run(args: &FleetLogArgs) -> Result<Outcome, CommandError> {
    let limits = Limits { time_s: args.time, memory_mb: args.memory };
    limits.take_hold().map_err(|why| CommandError::Failure(format!("cannot bound the process: {why}")))?;
    let mut text = String::new();
    let read = std::io::stdin().lock().take(MOST_TASK).read_to_string(&mut text);
    read.map_err(|error| CommandError::Input(format!("standard input: {error}")))?;
    let task: LogTask = serde_json::from_str(&text).map_err(|error| {
        CommandError::Input(format!("standard input: expected a task of mavid fleet: {error}"))
    })?;
    let rows = rows_text(&log_rows(&task)).map_err(|error| CommandError::Failure(error.to_string()))?;
    output::document(rows.trim_end_matches('\n'))?;
    Ok(Outcome::Done)
}
