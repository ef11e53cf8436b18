//! One flight of a run.

use std::path::Path;

use mavid::fly::{Ending, Record};
use mavid::text;

use super::context::Context;
use super::folder::Recorded;
use super::progress::Progress;
use super::step::Step;
use super::target::Target;
use crate::commands::fly::{self, FlightRun, Manner};
use crate::commands::log::LoggingNeeds;
use crate::commands::words::Word;
use crate::commands::{CommandError, log, output};

/// A flight that is over, and its logs.
#[derive(Debug)]
pub struct Flight {
    /// what was flown
    pub record: Record,
    /// where it is recorded
    pub recorded: Recorded,
}

/// Whether the logging may be changed for the flights: as it was said, or as a person agrees. What would be changed is looked
/// up before.
///
/// # Errors
/// The vehicle does not answer.
pub fn may_set_logging(context: &Context<'_>, target: &Target) -> Result<bool, CommandError> {
    if context.args.set_logging || target.embedded.is_some() {
        return Ok(context.args.set_logging);
    }
    let link = target.link();
    let step = Step::of(&["log", "prepare"])
        .option("--connect", &link.connect)
        .maybe("--system-id", link.system_id.map(|system| system.to_string()));
    context.tell(&step);
    context.work.ends_itself();
    let needs = log::logging_needs(&link);
    context.work.waits();
    let needs = match needs {
        Err(error @ CommandError::Ended(_)) => return Err(error),
        // a vehicle that does not say how it logs flies all the same: the link's recording is there
        Err(error) => {
            output::warning(&format!("how the vehicle logs is not known: {error}"));
            return Ok(false);
        }
        Ok(needs) => needs,
    };
    told(&needs).iter().for_each(Word::say);
    if needs.changes.is_empty() {
        return Ok(false);
    }
    let restart = if needs.restarts { " (this needs a restart of the autopilot)" } else { "" };
    let change = format!("{}{restart}", needs.changes);
    if !context.ask.is_person() {
        output::message(&format!("--set-logging would set {change}, and put it back after the flight"));
    }
    let question = format!("For a better log: set {change}, and put it back after the flight?");
    context.ask.agreed(&question, false)
}

/// What the vehicle logs, and whether that suffices.
fn told(needs: &LoggingNeeds) -> Vec<Word> {
    let until = if needs.awaited.is_some() { ", until the autopilot is restarted" } else { "" };
    let logs = needs.logs.iter().map(|line| Word::Message(format!("it logs {line}{until}")));
    let unknown = (!needs.unknown.is_empty())
        .then(|| Word::Message(format!("not known: {} did not answer", needs.unknown.join(", "))));
    let awaited = needs.awaited.clone().map(Word::Warning);
    let enough = needs.suffices.clone().map(Word::Message);
    logs.chain(unknown).chain(awaited).chain(enough).collect()
}

/// The step of a flight along a trajectory, into a folder.
pub fn step_of(
    context: &Context<'_>,
    target: &Target,
    (trajectory, out): (&Path, &Path),
    set_logging: bool,
) -> Step {
    let args = context.args;
    let own = target.embedded.is_some();
    Step::of(&["fly"])
        .option("--connect", &target.connect)
        .maybe("--system-id", target.system.map(|system| system.to_string()))
        .option("--vehicle", context.folder.vehicle())
        .option("--trajectory", trajectory)
        .option("--origin", "here")
        .option("--out", out)
        .maybe("--tracking-max", args.tracking_max.map(|most_m| most_m.to_string()))
        .flag("--set-logging", set_logging)
        .flag("--no-fetch-log", context.recipe.is_demo)
        .word("--record-only")
        .flag("--plain", args.plain)
        // a person types the word; without one it is armed only where that was said
        .flag("--arm", own || args.arm || context.ask.is_person())
        .flag("--yes", args.yes)
}

/// Flies by this step. A simulated vehicle of this program is armed and no other.
///
/// # Errors
/// It was not flown, or it did not land.
pub fn fly(context: &Context<'_>, target: &Target, step: &Step) -> Result<Flight, CommandError> {
    context.tell(step);
    let args = step.fly()?;
    // whoever watches a vehicle of the program has nothing to decide
    let brief = args.yes && target.embedded.is_some();
    let bar = brief.then(|| Progress::new(context.stderr, !args.plain && context.stderr.can_draw()));
    let watched = bar.clone();
    let manner = Manner {
        own: target.embedded.as_ref().map(|embedded| embedded.nonce),
        watches: watched
            .map(|bar| -> Box<dyn FnOnce(&_) + Send> { Box::new(move |pictures| bar.follow(pictures)) }),
    };
    let flown = fly::one_flight((context.stderr, context.work), &args, manner);
    bar.iter().for_each(Progress::end);
    let FlightRun { record, onboard, .. } = flown?;
    context.work.waits();
    let why = || record.outcome.cause.as_ref().map_or_else(String::new, |cause| format!(": {cause}"));
    match &record.outcome.ending {
        Ending::Landed | Ending::Fell => {
            let recorded = Recorded { radio: args.out.join(mavid::fly::TLOG), onboard };
            Ok(Flight { record, recorded })
        }
        Ending::NotFlown => {
            let arm = if args.arm { "" } else { "; everything was checked: --arm beside --yes flies" };
            Err(CommandError::Failure(format!("not flown{}{arm}", why())))
        }
        Ending::InTheAir(mode) => Err(CommandError::Failure(format!(
            "the vehicle was left in the air, mode {mode}{}; its recording is in {}",
            why(),
            text::path(&args.out)
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_for_a_restart_is_not_called_enough() {
        let needs = LoggingNeeds {
            logs: vec!["motor commands at 10 Hz".to_owned()],
            awaited: Some("the autopilot was not restarted".to_owned()),
            ..LoggingNeeds::default()
        };
        let waits = Word::Warning("the autopilot was not restarted".to_owned());
        let until = "it logs motor commands at 10 Hz, until the autopilot is restarted";
        assert_eq!(told(&needs), [Word::Message(until.to_owned()), waits]);
        let enough = LoggingNeeds { awaited: None, suffices: Some("enough".to_owned()), ..needs };
        assert_eq!(told(&enough)[1], Word::Message("enough".to_owned()));
    }
}
