//! The run of `mavid fly`, from the arguments to what the flight says.

use std::io::IsTerminal;

use mavid::fly::{Ending, Record};
use mavid::wire::SystemId;

use super::document::Document;
use super::ride::{asks_for_the_word, is_attended, ride};
use super::vehicle::file_of;
use super::watch::{View, Watch, fly_it, watch};
use super::words::words;
use crate::cli::FlyArgs;
use crate::commands::after_flight::Analysis;
use crate::commands::last_word::{PATIENCE, within};
use crate::commands::live::{self, Work};
use crate::commands::log::{self, Fetching};
use crate::commands::standard_error::StandardError;
use crate::commands::words::{Word, Words};
use crate::commands::{CommandError, Outcome, output};

/// Messages and log lines while the view is shown, in the folder of the flight.
const LOG: &str = "log.txt";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FlyArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| fly((json, &stderr), &args, work))
}

fn fly((json, stderr): (bool, &StandardError), args: &FlyArgs, work: &Work) -> Result<Outcome, CommandError> {
    let drawn = !args.plain && is_attended();
    if stderr.is_quiet() && !drawn && asks_for_the_word(args) {
        let expected =
            "--quiet: expected --yes with --arm and --plain: with --quiet nothing asks for the word";
        return Err(CommandError::Input(expected.to_owned()));
    }
    let mut ride = ride(args)?;
    if args.set_logging {
        // a signal ends the conversation with the vehicle
        work.ends_itself();
    }
    let before = log::before_flight(args)?;
    // the vehicle that was spoken to, and no other
    ride.sortie.system = before.system.map(SystemId).or(ride.sortie.system);
    ride.sortie.settings.log_awaited.clone_from(&before.awaited);
    let how = Watch {
        drawn: drawn.then(|| stderr.clone()),
        log: args.out.join(LOG),
        // lines of a script that did not ask for it are the script's
        typed: args.plain || std::io::stdin().is_terminal(),
        has_page: ride.sortie.settings.await_word,
    };
    let flown = fly_it(ride, work, move |pictures, pressed| watch(&how, pictures, pressed));
    let mut notes = Vec::new();
    if !before.noted.is_empty() {
        // not ended by a signal that ended the flight: what was set has to be put back
        work.flies();
        log::put_back(args, &before, &mut |note| notes.push(note));
        work.ends_itself();
    }
    let (record, view) = flown.inspect_err(|_| notes.iter().for_each(Word::say))?;
    let mut said = Words::new(view == View::Stuck);
    said.say(words(&record));
    said.say(std::mem::take(&mut notes));
    let landed = matches!(record.outcome.ending, Ending::Landed | Ending::Fell);
    let fetching = if record.outcome.ending == Ending::Landed { Fetching::of(args) } else { Fetching::Not };
    // each line when it is due: how long a download takes is said before it
    let onboard = log::after_flight((args, work), record.system, fetching, &mut |note| said.say(vec![note]));
    let flown = (&*args.out, landed, onboard.as_deref());
    let analysis = Analysis::of(flown, &file_of(args), record.system, &mut |note| notes.push(note));
    said.say(notes);
    let analysis = analysis?;
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
    let outcome = outcome(&record, analysis.as_ref())?;
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
