//! What the flights of a run say together, and what a further one would bring.

use std::path::{Path, PathBuf};

use mavid::fly::Record;
use mavid::report::{explanation_answer, next_flight_words};
use mavid::study::{ExplainStudy, FlightLogs, Progress};
use mavid::text;

use super::context::Context;
use super::folder::Recorded;
use super::step::Step;
use crate::commands::columns::columns;
use crate::commands::fly::{self, LOG, Landed};
use crate::commands::progress::Spinner;
use crate::commands::words::Word;
use crate::commands::{CommandError, explain, output};

/// What flights say.
#[derive(Debug)]
pub struct Explained {
    /// the answer and all that shows it
    pub study: ExplainStudy,
    /// what was read
    pub logs: Vec<PathBuf>,
}

/// Explains all flights together, and writes the one report and the one model into the root of the folder. After a flight that
/// was watched the view shows it.
///
/// # Errors
/// The flights say nothing.
pub fn explained(
    context: &Context<'_>,
    flights: &[Recorded],
    landed: Option<&Record>,
) -> Result<Explained, CommandError> {
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
    context.tell(&step);
    let shown = landed.filter(|_| context.is_drawn()).and_then(|record| {
        let title = text::path(context.folder.path());
        Landed::open(context.stderr, folder.of(LOG), (title, fly::lines(record)))
    });
    let study = match shown {
        Some(shown) => {
            let study = made(context, &step, &shown)?;
            // the view has its own columns
            shown.answered(sentences(&study).join("\n"), context.ask.is_person());
            study
        }
        None => made(context, &step, &Spinner::new(context.stderr))?,
    };
    remark(&study);
    Ok(Explained { study, logs })
}

/// Explains one flight into a folder of its own.
///
/// # Errors
/// The flight says nothing.
pub fn alone(context: &Context<'_>, log: &Path, out: &Path) -> Result<ExplainStudy, CommandError> {
    let step =
        Step::of(&["explain"]).word(log).option("--vehicle", context.folder.vehicle()).option("--out", out);
    context.tell(&step);
    let study = made(context, &step, &Spinner::new(context.stderr))?;
    remark(&study);
    Ok(study)
}

fn made(context: &Context<'_>, step: &Step, progress: &dyn Progress) -> Result<ExplainStudy, CommandError> {
    explain::make(progress, &step.explain()?).map_err(|error| match error {
        CommandError::Input(why) => CommandError::Input(format!(
            "{why}; to leave a flight out, move its folder out of {}, then: {}",
            text::path(context.folder.path()),
            context.again()
        )),
        other => other,
    })
}

/// What is doubtful about the data.
fn remark(study: &ExplainStudy) {
    explain::remarks(study).iter().filter(|word| matches!(word, Word::Warning(_))).for_each(Word::say);
}

/// The answer, and what a further flight would bring, in lines of the terminal.
pub fn answer(study: &ExplainStudy) -> String {
    let lines = sentences(study).into_iter().map(|sentence| text::wrapped(&sentence, columns()).join("\n"));
    lines.collect::<Vec<_>>().join("\n")
}

/// The same as sentences.
fn sentences(study: &ExplainStudy) -> Vec<String> {
    [Some(explanation_answer(study)), next_flight_words(study)].into_iter().flatten().collect()
}
