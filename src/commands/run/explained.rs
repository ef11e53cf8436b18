//! What the flights of a run say together, and what a further one would bring.

use std::path::{Path, PathBuf};

use mavid::report::{explanation_answer, next_flight_words};
use mavid::study::{ExplainStudy, FlightLogs};
use mavid::text;

use super::context::Context;
use super::folder::Recorded;
use super::step::Step;
use crate::commands::words::Word;
use crate::commands::{CommandError, explain, output};

/// Columns of a terminal whose width is not known.
const COLUMNS: usize = 80;

/// Columns of lines for people.
pub fn columns() -> usize {
    let columns = ratatui::crossterm::terminal::size().map_or(0, |(columns, _)| usize::from(columns));
    if columns == 0 { COLUMNS } else { columns.min(120) }
}

/// What flights say.
#[derive(Debug)]
pub struct Explained {
    /// the answer and all that shows it
    pub study: ExplainStudy,
    /// what was read
    pub logs: Vec<PathBuf>,
}

/// Explains all flights together, and writes the one report and the one model into the root of the folder.
///
/// # Errors
/// The flights say nothing.
pub fn explained(context: &Context<'_>, flights: &[Recorded]) -> Result<Explained, CommandError> {
    let mut logs = Vec::new();
    for flight in flights {
        let both = FlightLogs::of(&flight.radio, None, flight.onboard.as_deref());
        both.why.into_iter().for_each(|why| output::message(&why));
        logs.extend(both.logs);
    }
    let folder = &context.folder;
    let mut step = Step::of(&["explain"]);
    for log in &logs {
        step = step.word(log);
    }
    let mut step = step.option("--vehicle", folder.vehicle()).option("--out", folder.path());
    if !context.recipe.is_demo {
        step = step.option("--next", folder.next()).option("--limits", folder.limits());
    }
    Ok(Explained { study: made(context, &step)?, logs })
}

/// Explains one flight into a folder of its own.
///
/// # Errors
/// The flight says nothing.
pub fn alone(context: &Context<'_>, log: &Path, out: &Path) -> Result<ExplainStudy, CommandError> {
    let step =
        Step::of(&["explain"]).word(log).option("--vehicle", context.folder.vehicle()).option("--out", out);
    made(context, &step)
}

fn made(context: &Context<'_>, step: &Step) -> Result<ExplainStudy, CommandError> {
    context.tell(step);
    let study = explain::make(context.stderr, &step.explain()?).map_err(|error| match error {
        CommandError::Input(why) => CommandError::Input(format!(
            "{why}; to leave a flight out, move its folder out of {} and run the same command again",
            text::path(context.folder.path())
        )),
        other => other,
    })?;
    explain::remarks(&study).iter().filter(|word| matches!(word, Word::Warning(_))).for_each(Word::say);
    Ok(study)
}

/// The answer, and what a further flight would bring, in lines of the terminal.
pub fn answer(study: &ExplainStudy) -> String {
    let sentences = [Some(explanation_answer(study)), next_flight_words(study)];
    let lines =
        sentences.into_iter().flatten().map(|sentence| text::wrapped(&sentence, columns()).join("\n"));
    lines.collect::<Vec<_>>().join("\n")
}
