//! The run of `mavid log prepare`.

use crate::commands::agreement::{NO, SET, YES};
use std::io::{self, BufRead, IsTerminal};

use mavid::autopilot::{LogAwaited, LogChange};
use mavid::fetch::Noted;
use mavid::onboard::{self, ChangedSince, LoggingState, PutBack, Session};
use mavid::text::{self, parameter_value};
use serde::Serialize;

use super::link::open;
use super::restart::restart;
use super::{hint, state};
use crate::cli::{LogPrepareArgs, VehicleLinkArgs};
use crate::commands::{CommandError, Outcome, output, typed_early};

/// The document.
#[derive(Debug, Default, Serialize)]
struct Document {
    schema: u32,
    system: u32,
    autopilot: &'static str,
    logs: Vec<String>,
    changes: Vec<ChangeLine>,
    /// parameters that did not answer
    unknown: Vec<&'static str>,
    /// what was put back
    restored: Vec<RestoredLine>,
    /// what somebody else changed since, and stays
    left: Vec<RestoredLine>,
    /// what could not be put back, and stays noted
    not_restored: Vec<NotRestored>,
    /// parameters that count only after a restart that has not come since they were set
    awaiting_restart: Vec<&'static str>,
    /// the file with what was found
    notes: Option<String>,
    /// the autopilot must start anew
    restart: bool,
}

#[derive(Debug, Serialize)]
struct NotRestored {
    parameter: String,
    /// what it was before
    value: f64,
    why: String,
}

#[derive(Debug, Serialize)]
struct ChangeLine {
    parameter: &'static str,
    found: f64,
    wanted: f64,
    restarts: bool,
    set: bool,
}

#[derive(Debug, Serialize)]
struct RestoredLine {
    parameter: String,
    value: f64,
}

impl Document {
    /// Of a vehicle of which nothing else is to be said.
    fn of((system, autopilot): (u32, &'static str)) -> Self {
        Self { schema: 1, system, autopilot, ..Self::default() }
    }
}

/// Runs the verb.
pub async fn run(json: bool, args: &LogPrepareArgs) -> Result<Outcome, CommandError> {
    let mut session = open(&args.link).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    notes.read().map_err(|error| CommandError::Input(error.to_string()))?;
    let place = text::path(&notes.path());
    if args.restore {
        let put_back = onboard::put_back(&mut session, &notes, ChangedSince::Forgotten).await?;
        return restored(json, &session, &put_back, place);
    }
    let prepared = onboard::look(&mut session, &notes).await?;
    let changes = &prepared.plan.changes;
    if !json {
        output::text(&says(&session, &prepared))?;
    }
    if !prepared.noted.is_empty() {
        output::message(&earlier(&args.link, &prepared.noted));
    }
    let set = !changes.is_empty() && (args.set_logging || !json && agreed(SET, "set this")?);
    if set {
        onboard::change(&mut session, &prepared, changes, &notes).await?;
    }
    let names: Vec<&str> = changes.iter().map(|change| change.parameter).collect();
    let awaits = set && onboard::needs_restart(&session, &names) || !prepared.awaited.is_empty();
    let (known, whose) = (expect_rates(&session, &prepared), whose(&session));
    let restarts = args.restart && awaits;
    if restarts {
        restart(session, &args.link).await?;
    }
    let awaits = awaits && !restarts;
    if json {
        let line = |change: &LogChange| ChangeLine {
            parameter: change.parameter,
            found: change.found,
            wanted: change.needed,
            restarts: change.restarts,
            set,
        };
        let awaited = prepared.awaited.iter().filter(|_| awaits).map(|awaited| awaited.parameter);
        output::json(&Document {
            logs: prepared.plan.logs.clone(),
            changes: changes.iter().map(line).collect(),
            unknown: prepared.plan.unknown.clone(),
            awaiting_restart: awaited.collect(),
            notes: (set || !prepared.noted.is_empty()).then_some(place),
            restart: awaits,
            ..Document::of(whose)
        })?;
    } else if set {
        output::text(&set_page(&args.link, &place, (awaits, restarts)))?;
    } else if restarts {
        output::text("the autopilot was restarted: it logs by what was set")?;
    } else if !changes.is_empty() {
        output::text("nothing is changed; --set-logging sets it")?;
    }
    if args.set_logging { known.map(|()| Outcome::Done) } else { Ok(Outcome::Done) }
}

/// Number and autopilot of a vehicle.
fn whose(session: &Session) -> (u32, &'static str) {
    (session.vehicle.system.0, session.stack.id)
}

/// What was set, for people.
fn set_page(link: &VehicleLinkArgs, place: &str, (awaits, restarted): (bool, bool)) -> String {
    let restore = hint::restore(link);
    let mut page = format!("set; what was found stands in {place}\nafter the flight: {restore} puts it back");
    if awaits {
        page.push_str(
            "\nrestart the autopilot now: until then it logs as before. With --restart mavid restarts it",
        );
    }
    if restarted {
        page.push_str("\nthe autopilot was restarted: it logs by what was set");
    }
    page
}

fn says(session: &Session, prepared: &LoggingState) -> String {
    let LoggingState { plan, awaited, .. } = prepared;
    let (changes, unknown) = (&plan.changes, &plan.unknown);
    let until = if awaited.is_empty() { "" } else { " until the autopilot is restarted" };
    let mut lines =
        vec![format!("system {}, {}, logs in flight{until}:", session.vehicle.system, session.stack.name)];
    lines.extend(plan.logs.iter().map(|line| format!("  {line}")));
    if !unknown.is_empty() {
        lines.push(format!("not known: {} did not answer", unknown.join(", ")));
    }
    if !awaited.is_empty() {
        lines.push(restart_now(awaited));
    }
    lines.extend(suffices(session, prepared));
    for change in changes {
        let LogChange { parameter, found, needed, restarts } = change;
        let restart = if *restarts { ", after a restart of the autopilot" } else { "" };
        let setting =
            session.stack.log_settings.settings.iter().find(|setting| setting.parameter == *parameter);
        let words = setting.map_or("", |setting| setting.words);
        lines.push(format!(
            "for an identification: {parameter} = {needed} instead of {found}{restart} ({words})"
        ));
    }
    lines.join("\n")
}

/// What is said where nothing is to be changed and all is known: that it suffices, as far as the vehicle tells.
pub fn suffices(session: &Session, prepared: &LoggingState) -> Option<String> {
    let LoggingState { plan, awaited, unsure, noted, .. } = prepared;
    if !(plan.changes.is_empty() && plan.unknown.is_empty() && awaited.is_empty()) {
        return None;
    }
    Some(match session.stack.log_rates_from_start() {
        Some(name) if !unsure.is_empty() => format!(
            "that is enough for an identification if the autopilot was restarted since {name} was set. The \
             autopilot's uptime does not show whether it was restarted."
        ),
        Some(name) if !noted.iter().any(|noted| noted.name == name) => format!(
            "that is enough for an identification, if {name} was not changed since the autopilot's last start"
        ),
        _ => "that is enough for an identification".to_owned(),
    })
}

/// What waits for a restart.
pub fn restart_now(awaited: &[LogAwaited]) -> String {
    let list = awaited.iter().map(|LogAwaited { parameter, set, runs_by }| {
        format!("{parameter} = {set} is set, and it still runs by {runs_by}")
    });
    format!(
        "the autopilot was not restarted since its logging was set ({}): restart it now, or have it restarted by \
         mavid log prepare --set-logging --restart",
        list.collect::<Vec<_>>().join("; ")
    )
}

/// Fails where the vehicle did not answer for what sets the rates of its log: that was to be set.
pub fn expect_rates(session: &Session, state: &LoggingState) -> Result<(), CommandError> {
    let unknown = session.stack.rates_unknown(&state.plan).join(", ");
    if unknown.is_empty() {
        return Ok(());
    }
    Err(CommandError::Failure(format!(
        "--set-logging: expected an answer for {unknown}, which sets the rates of the log, the vehicle gave none: it is not set. \
         Try again on a better link, or set it with another ground station"
    )))
}

/// What is changed, for people.
pub fn changes_page(changes: &[LogChange]) -> String {
    let one =
        |change: &LogChange| format!("{} = {} instead of {}", change.parameter, change.needed, change.found);
    changes.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// What is said where an earlier run changed something that is not put back.
pub fn earlier(link: &VehicleLinkArgs, noted: &[Noted]) -> String {
    let list = noted.iter().map(|noted| {
        format!("{} from {} to {}", noted.name, parameter_value(noted.found), parameter_value(noted.set))
    });
    format!(
        "an earlier run changed {} on this vehicle: {} puts it back",
        list.collect::<Vec<_>>().join(", "),
        hint::restore(link)
    )
}

/// Somebody at a terminal agrees by this word.
pub fn agreed(word: &str, what: &str) -> Result<bool, CommandError> {
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return Ok(false);
    }
    typed_early::throw_away();
    output::message(&format!("type {word} or y and return to {what}, or return alone to leave it"));
    let mut line = String::new();
    let read = io::stdin().lock().read_line(&mut line);
    read.map_err(|error| CommandError::Failure(format!("cannot read standard input: {error}")))?;
    let answer = line.trim().to_ascii_lowercase();
    let agrees = answer == word || YES.contains(&answer.as_str());
    if !agrees && !answer.is_empty() && !NO.contains(&answer.as_str()) {
        output::message(&format!(
            "expected {word}, y or n, got {}: treated as no",
            text::excerpt(&answer, 20)
        ));
    }
    Ok(agrees)
}

fn restored(
    json: bool,
    session: &Session,
    put_back: &PutBack,
    place: String,
) -> Result<Outcome, CommandError> {
    if json {
        let line = |name: &str, value: f64| RestoredLine { parameter: name.to_owned(), value };
        let not_restored = |(noted, why): &(Noted, String)| NotRestored {
            parameter: noted.name.clone(),
            value: noted.found,
            why: why.clone(),
        };
        output::json(&Document {
            restored: put_back.done.iter().map(|noted| line(&noted.name, noted.found)).collect(),
            left: put_back.left.iter().map(|(noted, now)| line(&noted.name, *now)).collect(),
            not_restored: put_back.failed.iter().map(not_restored).collect(),
            notes: (!put_back.failed.is_empty()).then(|| place.clone()),
            restart: put_back.restart,
            ..Document::of(whose(session))
        })?;
    } else {
        output::text(&put_back_page(put_back))?;
    }
    all_put_back(put_back, &place)
}

/// Fails where something was not put back: the values stand in the notes at `place`.
pub fn all_put_back(put_back: &PutBack, place: &str) -> Result<Outcome, CommandError> {
    if put_back.failed.is_empty() {
        return Ok(Outcome::Done);
    }
    let names: Vec<&str> = put_back.failed.iter().map(|(noted, _)| noted.name.as_str()).collect();
    Err(CommandError::Failure(format!(
        "{} not put back: the values stand in {place}, and the same command tries again",
        names.join(", ")
    )))
}

/// What was put back, for people.
pub fn put_back_page(put_back: &PutBack) -> String {
    let mut lines: Vec<String> = put_back
        .done
        .iter()
        .map(|noted| format!("{} is {} again", noted.name, parameter_value(noted.found)))
        .collect();
    for (noted, now) in &put_back.left {
        lines.push(format!(
            "{} stays {}: it was set to {}, and somebody changed it since (it was {})",
            noted.name,
            parameter_value(*now),
            parameter_value(noted.set),
            parameter_value(noted.found)
        ));
    }
    for (noted, why) in &put_back.failed {
        lines.push(format!("{} is not put back to {}: {why}", noted.name, parameter_value(noted.found)));
    }
    if lines.is_empty() {
        lines.push("nothing to put back on this vehicle".to_owned());
    } else if put_back.restart {
        lines.push("the autopilot logs so after its next start".to_owned());
    }
    lines.join("\n")
}
