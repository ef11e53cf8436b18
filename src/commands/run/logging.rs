//! What becomes of the vehicle's logging for the flights of a run. No answer to it ends the run.

use super::context::Context;
use super::step::Step;
use super::target::Target;
use crate::commands::log::{LoggingNeeds, logging_needs, put_back_now, set_and_restart};
use crate::commands::words::Word;
use crate::commands::{CommandError, output};

/// What becomes of the vehicle's logging.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Logging {
    /// it stays as it is
    Left,
    /// it is set before each flight, and put back after it
    EachFlight,
    /// it is set, and put back after the last flight: it counts only after a restart of the autopilot
    UntilTheEnd,
}

impl Logging {
    /// Further words of the step of a flight.
    pub fn of(self, step: Step) -> Step {
        step.flag("--set-logging", self != Self::Left).flag("--keep-logging", self == Self::UntilTheEnd)
    }
}

/// What can be done for a better log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Offer {
    /// nothing is needed
    Nothing,
    /// it was set by this program for flights, and counts
    Own,
    /// it counts as soon as it is set
    Set,
    /// it counts after a restart of the autopilot
    Restart,
}

fn offer(needs: &LoggingNeeds) -> Offer {
    if needs.awaited.is_some() || needs.restarts {
        return Offer::Restart;
    }
    match (needs.changes.is_empty(), needs.is_own) {
        (false, _) => Offer::Set,
        (true, true) => Offer::Own,
        (true, false) => Offer::Nothing,
    }
}

/// Decides it: as it was said, or as a person agrees. What would be changed is looked up before. The autopilot is restarted only
/// after a yes to just that.
///
/// # Errors
/// A signal ended it, or there is no answer that can be used.
pub fn decided(context: &Context<'_>, target: &Target) -> Result<Logging, CommandError> {
    let wanted = context.args.set_logging;
    if target.embedded.is_some() {
        return Ok(if wanted { Logging::EachFlight } else { Logging::Left });
    }
    // where nobody is there, a flight whose logging cannot be set as it was said is not flown: its step says why
    let unasked = if wanted && !context.ask.is_person() { of_flights(context) } else { Logging::Left };
    let Some(needs) = looked_up(context, target)? else { return Ok(unasked) };
    told(&needs).iter().for_each(Word::say);
    let change = match needs.changes.as_str() {
        "" => "what was set before",
        changes => changes,
    };
    match offer(&needs) {
        Offer::Nothing => Ok(unasked),
        Offer::Own => {
            output::message(
                "this was set by mavid: it stays for the flights of this run, and is put back after the last one",
            );
            Ok(if needs.own_restarts { Logging::UntilTheEnd } else { Logging::EachFlight })
        }
        Offer::Set if wanted => Ok(of_flights(context)),
        Offer::Set if !context.ask.is_person() => {
            output::message(&format!("--set-logging would set {change}, and put it back after the flight"));
            Ok(Logging::Left)
        }
        Offer::Set => {
            let question = format!("For a better log: set {change}, and put it back after the flight?");
            let agreed = context.ask.agreed(&question, false)?;
            Ok(if agreed { Logging::EachFlight } else { Logging::Left })
        }
        Offer::Restart => {
            let question = format!(
                "For a better log: set {change} and restart the autopilot now? It is put back after the last flight"
            );
            if context.args.restart || context.ask.agreed_expressly(&question)? {
                return restarted(context, target);
            }
            output::message(&without(&needs, &step(target).line(), wanted));
            Ok(Logging::Left)
        }
    }
}

/// What is set for every flight: before each of them, or once where there may be several.
fn of_flights(context: &Context<'_>) -> Logging {
    let further = context.flights_max() > 1 && !context.ask.is_person();
    if further { Logging::UntilTheEnd } else { Logging::EachFlight }
}

/// How the vehicle logs; `None` of one that does not say it: it flies all the same, and the link's recording is there.
fn looked_up(context: &Context<'_>, target: &Target) -> Result<Option<LoggingNeeds>, CommandError> {
    let link = target.link();
    context.tell(&of_vehicle(target));
    context.work.ends_itself();
    let needs = logging_needs(&link);
    context.work.waits();
    match needs {
        Err(error @ CommandError::Ended(_)) => Err(error),
        Err(error) => {
            output::warning(&format!("how the vehicle logs is not known: {error}"));
            Ok(None)
        }
        Ok(needs) => Ok(Some(needs)),
    }
}

/// `mavid log prepare` of this vehicle.
fn of_vehicle(target: &Target) -> Step {
    let link = target.link();
    Step::of(&["log", "prepare"])
        .option("--connect", &link.connect)
        .maybe("--system-id", link.system_id.map(|system| system.to_string()))
}

/// The same with a restart.
fn step(target: &Target) -> Step {
    of_vehicle(target).word("--set-logging").word("--restart")
}

/// Sets it and restarts the autopilot. Where that fails, the flights go on with the log as it was.
fn restarted(context: &Context<'_>, target: &Target) -> Result<Logging, CommandError> {
    context.tell(&step(target));
    context.work.ends_itself();
    let done = set_and_restart(&target.link());
    context.work.waits();
    match done {
        Ok(()) => Ok(Logging::UntilTheEnd),
        Err(error @ CommandError::Ended(_)) => Err(error),
        Err(error) => {
            let by_hand = of_vehicle(target).word("--set-logging").line();
            output::warning(&format!(
                "{error}; the flight goes on with the log as it was. To restart it by hand before another flight: {by_hand}"
            ));
            put_back(context, target);
            Ok(Logging::Left)
        }
    }
}

/// Puts the logging back after the last flight, however the run ended. What cannot be put back is told with the command that does it.
pub fn put_back(context: &Context<'_>, target: &Target) {
    let step = of_vehicle(target).word("--restore");
    context.tell(&step);
    context.work.ends_itself();
    let done = put_back_now(&target.link());
    context.work.waits();
    match done {
        Ok(lines) => lines.iter().for_each(|line| output::message(&format!("logging: {line}"))),
        Err(error) => {
            output::warning(&format!("the logging is not put back: {error}; later: {}", step.line()))
        }
    }
}

/// What a flight lacks without the restart, and what brings it: to whoever asked for it in this run, the option.
fn without(needs: &LoggingNeeds, step: &str, wanted: bool) -> String {
    let brings = match needs.would_log.as_slice() {
        [] => String::new(),
        logs => format!(" ({})", logs.join("; ")),
    };
    let wants = if wanted {
        "the setting counts only after a restart of the autopilot, which --restart beside --set-logging orders: nothing is set, and "
    } else {
        ""
    };
    format!(
        "{wants}the flight goes on with the log as it is, and with the recording of the link. A better log{brings} for the next \
         flight: {step}"
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    fn needs() -> LoggingNeeds {
        LoggingNeeds { logs: vec!["motor commands at 10 Hz".to_owned()], ..LoggingNeeds::default() }
    }

    #[test]
    fn what_waits_for_a_restart_is_not_called_enough() {
        let needs = LoggingNeeds { awaited: Some("the autopilot was not restarted".to_owned()), ..needs() };
        let waits = Word::Warning("the autopilot was not restarted".to_owned());
        let until = "it logs motor commands at 10 Hz, until the autopilot is restarted";
        assert_eq!(told(&needs), [Word::Message(until.to_owned()), waits]);
        let enough = LoggingNeeds { awaited: None, suffices: Some("enough".to_owned()), ..needs };
        assert_eq!(told(&enough)[1], Word::Message("enough".to_owned()));
    }

    #[test]
    fn a_run_does_not_ask_to_undo_what_it_set_itself() {
        let changes = "SDLOG_PROFILE = 9 instead of 1".to_owned();
        assert_eq!(offer(&needs()), Offer::Nothing);
        assert_eq!(offer(&LoggingNeeds { changes: changes.clone(), ..needs() }), Offer::Set);
        assert_eq!(offer(&LoggingNeeds { changes, restarts: true, ..needs() }), Offer::Restart);
        // set by an earlier run: before the autopilot was restarted, and after
        let own = LoggingNeeds { is_own: true, own_restarts: true, ..needs() };
        let awaited = Some("not restarted".to_owned());
        assert_eq!(offer(&LoggingNeeds { awaited, ..own.clone() }), Offer::Restart);
        assert_eq!(offer(&own), Offer::Own);
    }

    #[test]
    fn without_a_restart_it_is_said_what_the_next_flight_would_bring() {
        // longer than a name in a list
        let rates = "motor commands, torque setpoints, gyroscope and accelerometer at their full rate";
        let would_log = vec![rates.to_owned()];
        let needs = LoggingNeeds { would_log, ..needs() };
        let said = without(&needs, "mavid log prepare", false);
        assert!(said.contains(&format!("({rates}) for the next flight: mavid log prepare")), "{said}");
        let asked = without(&needs, "mavid log prepare", true);
        assert!(asked.contains("--restart beside --set-logging") && asked.ends_with(&said), "{asked}");
    }

    #[test]
    fn what_needs_a_restart_is_put_back_after_the_last_flight() {
        let line = |logging: Logging| logging.of(Step::of(&["fly"])).line();
        assert_eq!(line(Logging::Left), "mavid fly");
        assert_eq!(line(Logging::EachFlight), "mavid fly --set-logging");
        assert_eq!(line(Logging::UntilTheEnd), "mavid fly --set-logging --keep-logging");
    }
}
