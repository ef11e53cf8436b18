//! The run of `mavid fly`, from the arguments to what the flight says.

use std::io::IsTerminal;

use mavid::fly::{Ending, Record};

use super::document::Document;
use super::ride::ride;
use super::watch::{View, Watch, fly_it, watch};
use super::words::words;
use crate::cli::FlyArgs;
use crate::commands::after_flight::Analysis;
use crate::commands::live::{self, Work};
use crate::commands::patience::{PATIENCE, Words, within};
use crate::commands::{CommandError, Outcome, output};

/// Runs the verb.
pub fn run(json: bool, args: &FlyArgs) -> Result<Outcome, CommandError> {
    let args = args.clone();
    live::run(move |work| fly(json, &args, work))
}

fn fly(json: bool, args: &FlyArgs, work: &Work) -> Result<Outcome, CommandError> {
    let ride = ride(args)?;
    let how = Watch {
        drawn: !args.plain && std::io::stderr().is_terminal() && std::io::stdin().is_terminal(),
        // lines of a script that did not ask for it are the script's
        typed: args.plain || std::io::stdin().is_terminal(),
        has_page: ride.sortie.settings.await_word,
    };
    let (record, view) = fly_it(ride, work, move |pictures, pressed| watch(how, pictures, pressed))?;
    let mut said = Words::new(view == View::Ended);
    said.say(words(&record));
    let landed = matches!(record.outcome.ending, Ending::Landed | Ending::Fell);
    let system = record.system.map(|system| system.0);
    let mut notes = Vec::new();
    let analysis = Analysis::of((&args.out, landed), &args.vehicle, system, &mut |note| notes.push(note));
    said.say(notes);
    let analysis = analysis?;
    let told = if json {
        let document = output::json_text(&Document::new(&record, &args.out, analysis.as_ref()))?;
        result(&said, move || output::document(&document))?
    } else if let Some(page) = analysis.as_ref().map(Analysis::page) {
        result(&said, move || output::text(&page))?
    } else {
        true
    };
    said.say(analysis.as_ref().map(Analysis::remarks).unwrap_or_default());
    let outcome = outcome(&record, analysis.as_ref())?;
    // all is done and in its files, but not all of it was told
    Ok(if told && said.are_heard() { outcome } else { Outcome::DoneWithLoss })
}

/// Tells a result: a reader of a pipe has as much time as it takes, a terminal has as much as for all else. Whether it was
/// told.
fn result(
    said: &Words,
    tell: impl FnOnce() -> Result<(), CommandError> + Send + 'static,
) -> Result<bool, CommandError> {
    if !std::io::stdout().is_terminal() {
        return tell().map(|()| true);
    }
    if !said.are_heard() {
        // that it is the same terminal is next to certain
        return Ok(false);
    }
    within(PATIENCE, tell).map_or(Ok(false), |told| told.map(|()| true))
}

/// How a flight and what was made of it end the program.
pub fn outcome(record: &Record, analysis: Option<&Analysis>) -> Result<Outcome, CommandError> {
    let outcome = &record.outcome;
    if outcome.ending == Ending::NotFlown {
        let why = outcome.cause.as_ref().map_or("no reason given".to_owned(), ToString::to_string);
        return Err(CommandError::Failure(format!("not flown: {why}")));
    }
    let whole = outcome.is_whole()
        && outcome.losses.is_empty()
        && record.recorder.is_whole()
        && record.events_failure.is_none();
    match analysis.map(Analysis::outcome) {
        Some(Err(failure)) if outcome.is_whole() => Err(failure),
        Some(Ok(outcome)) if whole => Ok(outcome),
        // it was told to fly where nothing can be identified
        None if whole => Ok(Outcome::Done),
        _ => Ok(Outcome::DoneWithLoss),
    }
}
