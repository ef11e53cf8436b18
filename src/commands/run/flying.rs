//! One flight of a run.

use std::path::Path;

use mavid::fly::{Ending, Outcome, Record};
use mavid::text;

use super::context::Context;
use super::embedded::Embedded;
use super::folder::{Recorded, set_aside};
use super::logging::Logging;
use super::progress::Progress;
use super::step::Step;
use super::target::Target;
use crate::commands::CommandError;
use crate::commands::fly::{self, FlightRun, Manner};

/// A flight that is over, and its logs.
#[derive(Debug)]
pub struct Flight {
    /// what was flown
    pub record: Record,
    /// where it is recorded
    pub recorded: Recorded,
}

/// The step of a flight along a trajectory, into a folder.
pub fn step_of(
    context: &Context<'_>,
    target: &Target,
    (trajectory, out): (&Path, &Path),
    logging: Logging,
) -> Step {
    let args = context.args;
    let own = target.embedded.is_some();
    let step = Step::of(&["fly"])
        .option("--connect", &target.connect)
        .maybe("--system-id", target.system.map(|system| system.to_string()))
        .option("--vehicle", context.folder.vehicle())
        .option("--trajectory", trajectory)
        .option("--origin", "here")
        .option("--out", out)
        .maybe("--tracking-max", args.tracking_max.map(|most_m| most_m.to_string()));
    logging
        .of(step)
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
    // what was before is none of this flight's
    let stood = || target.embedded.as_ref().map(Embedded::stood);
    stood();
    // whoever watches a vehicle of the program has nothing to decide
    let brief = args.yes && target.embedded.is_some();
    let bar = brief.then(|| Progress::new(context.stderr, !args.plain && context.stderr.can_draw()));
    let watched = bar.clone();
    let manner = Manner {
        own: target.embedded.as_ref().map(|embedded| embedded.nonce),
        watches: watched
            .map(|bar| -> Box<dyn FnOnce(&_) + Send> { Box::new(move |pictures| bar.follow(pictures)) }),
        is_twin: target.is_twin,
        decided: true,
    };
    let flown = fly::one_flight((context.stderr, context.work), &args, manner);
    bar.iter().for_each(Progress::end);
    let FlightRun { record, onboard, .. } = flown?;
    context.work.waits();
    let busy = target.embedded.as_ref().and_then(|_| fly::busy(&record.outcome, &record.stream, stood()));
    let again = context.again();
    if let Some(why) = &busy
        && !target.is_twin
    {
        // half a flight of a vehicle that can be flown again at once
        set_aside(&args.out, why)?;
    }
    let whose = match &target.embedded {
        _ if target.is_twin => Whose::Twin,
        Some(_) => Whose::Embedded,
        None => Whose::Pilot,
    };
    match unfinished(&record.outcome, (whose, &args.out), (args.arm, &again)) {
        Some(why) => Err(with_busy(why, busy, &again)),
        None if busy.is_some() => {
            let cause = record.outcome.cause.as_ref().map_or_else(String::new, ToString::to_string);
            Err(with_busy(CommandError::Failure(format!("the flight ended early: {cause}")), busy, &again))
        }
        None => {
            let recorded = Recorded { radio: args.out.join(mavid::fly::TLOG), onboard };
            Ok(Flight { record, recorded })
        }
    }
}

/// The same with what was measured of a busy computer, and the command with which it is flown again.
fn with_busy(why: CommandError, busy: Option<String>, again: &str) -> CommandError {
    match (why, busy) {
        (CommandError::Failure(why), Some(busy)) => CommandError::Failure(format!("{why}; {busy}: {again}")),
        (why, _) => why,
    }
}

/// Why there is no flight to explain; `None` where it came down. `arms` as it was said; `again` continues a run that was interrupted.
fn unfinished(
    outcome: &Outcome,
    (whose, out): (Whose, &Path),
    (arms, again): (bool, &str),
) -> Option<CommandError> {
    let why = || outcome.cause.as_ref().map_or_else(String::new, |cause| format!(": {cause}"));
    match &outcome.ending {
        Ending::Landed | Ending::Fell => None,
        Ending::NotFlown if outcome.is_interrupted() => {
            Some(CommandError::Ended(format!("not flown{}; to continue: {again}", why())))
        }
        Ending::NotFlown => {
            let arm = if arms { "" } else { "; everything was checked: --arm beside --yes flies" };
            Some(CommandError::Failure(format!("not flown{}{arm}", why())))
        }
        Ending::InTheAir(mode) => {
            let said = in_the_air((whose, out), (mode, &why()), again);
            // a twin that nobody ended failed; a vehicle has its pilot or its own hold
            let has_failed = whose == Whose::Twin && !outcome.is_interrupted();
            Some(if has_failed { CommandError::Failure(said) } else { CommandError::Ended(said) })
        }
    }
}

/// Who has a vehicle that is left in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Whose {
    /// nobody: it rehearses a flight
    Twin,
    /// nobody: it ends with the program
    Embedded,
    /// its pilot
    Pilot,
}

/// What is said where it was left in the air. Whoever rehearses says where the twin's recording is.
fn in_the_air(
    (whose, out): (Whose, &Path),
    (mode, why): (impl std::fmt::Display, &str),
    again: &str,
) -> String {
    let kept = text::path(out);
    match whose {
        Whose::Twin => format!("the twin was left in the air, mode {mode}{why}"),
        Whose::Embedded => format!(
            "the vehicle of the program was left in the air, mode {mode}{why}, and ended with it; its recording is in {kept}. To fly \
             again: {again}"
        ),
        Whose::Pilot => {
            format!(
                "the vehicle was left in the air, mode {mode}{why}; its recording is in {kept}. Land it by the transmitter or with another \
                 ground station, and give the same command again when it is disarmed"
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::fly::{Cause, FlightStatistics};

    /// The exit status of a run whose flight ended so, and what is said; none of one that is explained.
    fn status(cause: Option<Cause>, ending: Ending, whose: Whose) -> Option<(u8, String)> {
        let outcome = Outcome { cause, ending, flown: FlightStatistics::default(), losses: Vec::new() };
        let why = unfinished(&outcome, (whose, Path::new("run/flight1")), (true, "mavid run --out run"))?;
        Some((why.status(), why.to_string()))
    }

    #[test]
    fn a_run_that_was_ended_has_the_exit_status_of_a_flight_that_was() {
        let signal = || Some(Cause::Signal("Ctrl-C".to_owned()));
        let (of_ground, said) = status(signal(), Ending::NotFlown, Whose::Pilot).unwrap();
        assert_eq!(
            (of_ground, said.as_str()),
            (3, "not flown: ended by Ctrl-C; to continue: mavid run --out run")
        );
        for cause in [signal(), Some(Cause::Override("the pilot".to_owned()))] {
            assert_eq!(status(cause, Ending::InTheAir("hold".to_owned()), Whose::Pilot).unwrap().0, 3);
        }
        assert_eq!(status(signal(), Ending::InTheAir("hold".to_owned()), Whose::Twin).unwrap().0, 3);
        let refused = Some(Cause::Refused("the battery is low".to_owned()));
        assert_eq!(status(refused, Ending::NotFlown, Whose::Pilot).unwrap().0, 1);
        assert_eq!(
            status(Some(Cause::Reboot), Ending::InTheAir("hold".to_owned()), Whose::Twin).unwrap().0,
            1
        );
        assert_eq!(status(signal(), Ending::Landed, Whose::Pilot), None);
    }

    #[test]
    fn a_busy_computer_is_said_with_the_command_that_flies_again() {
        let busy = || Some("this computer was too busy for the flight: measured; fly again".to_owned());
        let said =
            with_busy(CommandError::Failure("not flown: lost".to_owned()), busy(), "mavid demo --out d");
        assert_eq!(
            said.to_string(),
            "not flown: lost; this computer was too busy for the flight: measured; fly again: mavid demo --out d"
        );
        let none = with_busy(CommandError::Failure("not flown: lost".to_owned()), None, "mavid demo --out d");
        assert_eq!(none.to_string(), "not flown: lost");
    }

    #[test]
    fn a_recording_is_named_once() {
        let out = Path::new("run/rehearsal2");
        let said = in_the_air((Whose::Pilot, out), ("hold", ": Ctrl-C"), "mavid run");
        assert!(said.contains("mode hold: Ctrl-C; its recording is in run/rehearsal2"), "{said}");
        let twin = in_the_air((Whose::Twin, out), ("hold", ""), "mavid run");
        assert_eq!(twin, "the twin was left in the air, mode hold");
        let embedded = in_the_air((Whose::Embedded, out), ("hold", ""), "mavid run --sitl");
        assert!(embedded.ends_with("run/rehearsal2. To fly again: mavid run --sitl"), "{embedded}");
    }
}
