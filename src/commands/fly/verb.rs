//! The run of `mavid fly`, from the arguments to what the flight says.

use std::io::IsTerminal;

use mavid::fly::{Ending, Record};
use mavid::study::{Progress, Silent};
use mavid::text;

use super::document::Document;
use super::landed::Landed;
use super::one_flight::{FlightRun, LOG, Manner, one_flight};
use super::ride::{asks_for_the_word, is_drawn};
use super::vehicle::{file_of, kept};
use super::watch::View;
use super::words::lines;
use crate::cli::FlyArgs;
use crate::commands::after_flight::Analysis;
use crate::commands::last_word::{PATIENCE, within};
use crate::commands::live::{self, Work};
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FlyArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| fly((json, &stderr), &args, work))
}

fn fly((json, stderr): (bool, &StandardError), args: &FlyArgs, work: &Work) -> Result<Outcome, CommandError> {
    let args = &kept(args)?;
    let FlightRun { record, onboard, mut said, view } = one_flight((stderr, work), args, Manner::default())?;
    let landed = matches!(record.outcome.ending, Ending::Landed | Ending::Fell);
    let mut notes = Vec::new();
    let flown = (&*args.out, landed, onboard.as_deref());
    let (mut view, mut landed_view) = (view, None);
    let analysis = if args.record_only {
        None
    } else {
        // what was said of the flight is on the terminal already
        if landed && view == View::Ended && said.are_heard() && is_drawn(args) {
            landed_view = Landed::open(stderr, args.out.join(LOG), (text::path(&args.out), lines(&record)));
        }
        let watches: &dyn Progress = landed_view.as_ref().map_or(&Silent, |view| view);
        work.analyses();
        let made =
            Analysis::of(flown, &file_of(args), record.system, (watches, &mut |note| notes.push(note)));
        work.ends_itself();
        made?
    };
    if let (Some(shown), Some(analysis)) = (landed_view, &analysis) {
        view = shown.answered(analysis.answer(), asks_for_the_word(args));
    }
    said.say(notes);
    let heard = view == View::Ended && said.are_heard();
    let told = if json {
        let document = output::json_text(&Document::new(&record, &args.out, analysis.as_ref()))?;
        result(heard, move || output::document(&document))?
    } else if let Some(page) = analysis.as_ref().map(Analysis::page) {
        result(heard, move || output::text(&page))?
    } else {
        true
    };
    said.say(analysis.as_ref().map(Analysis::remarks).unwrap_or_default());
    let outcome = outcome(&record, analysis.as_ref().map(Analysis::outcome))?;
    // all is done and in its files, but not all of it was told
    Ok(if told && view == View::Ended && said.are_heard() { outcome } else { Outcome::DoneWithLoss })
}

/// Tells a result: a reader of a pipe has as much time as it takes, a terminal has as much as for all else. Whether it was
/// told.
fn result(
    heard: bool,
    tell: impl FnOnce() -> Result<(), CommandError> + Send + 'static,
) -> Result<bool, CommandError> {
    if !std::io::stdout().is_terminal() {
        return tell().map(|()| true);
    }
    if !heard {
        // that it is the same terminal is next to certain
        return Ok(false);
    }
    within(PATIENCE, tell).map_or(Ok(false), |told| told.map(|()| true))
}

/// How a flight and what was made of it end the program; `None`: it was told to fly where nothing can be identified.
pub fn outcome(
    record: &Record,
    analysed: Option<Result<Outcome, CommandError>>,
) -> Result<Outcome, CommandError> {
    let outcome = &record.outcome;
    if outcome.ending == Ending::NotFlown {
        let why = outcome.cause.as_ref().map_or("no reason given".to_owned(), ToString::to_string);
        let why = format!("not flown: {why}");
        return Err(if outcome.is_interrupted() {
            CommandError::Ended(why)
        } else {
            CommandError::Failure(why)
        });
    }
    let whole = outcome.is_whole()
        && outcome.losses.is_empty()
        && record.recorder.is_whole()
        && record.events_failure.is_none();
    match analysed {
        Some(Err(failure)) if outcome.is_whole() => Err(failure),
        Some(Ok(outcome)) if whole => Ok(outcome),
        None if whole => Ok(Outcome::Done),
        _ => Ok(Outcome::DoneWithLoss),
    }
}
