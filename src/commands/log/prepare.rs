//! The run of `mavid log prepare`.

use std::io::{self, BufRead, IsTerminal};

use mavid::autopilot::LogChange;
use mavid::fetch::Noted;
use mavid::text;
use serde::Serialize;

use super::preparing::{self, PutBack};
use super::session::Session;
use super::state;
use crate::cli::LogPrepareArgs;
use crate::commands::{CommandError, Outcome, output};

/// The word that agrees at a terminal.
const YES: &str = "set";

/// The document.
#[derive(Debug, Serialize)]
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
    /// the file with what was found
    notes: Option<String>,
    /// the autopilot must start anew
    restart: bool,
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

/// Runs the verb.
pub async fn run(json: bool, args: &LogPrepareArgs) -> Result<Outcome, CommandError> {
    let mut session = Session::open(&args.link).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    let noted = notes.read().map_err(|error| CommandError::Input(error.to_string()))?;
    if args.restore {
        let put_back = preparing::put_back(&mut session, &notes).await?;
        return restored(json, &session, &put_back);
    }
    let prepared = preparing::look(&mut session).await?;
    let changes = &prepared.plan.changes;
    if !json {
        output::text(&says(&session, &prepared.plan.logs, changes, &prepared.plan.unknown))?;
    }
    if !noted.is_empty() {
        output::message(&earlier(&noted));
    }
    let set = !changes.is_empty() && (args.set_logging || !json && agreed(YES, "set this")?);
    if set {
        preparing::change(&mut session, &prepared, changes, &notes).await?;
    }
    let names: Vec<&str> = changes.iter().map(|change| change.parameter).collect();
    let restart = set && preparing::needs_restart(&session, &names);
    let place = text::path(&notes.path());
    if json {
        let line = |change: &LogChange| ChangeLine {
            parameter: change.parameter,
            found: change.found,
            wanted: change.wanted,
            restarts: change.restarts,
            set,
        };
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            logs: prepared.plan.logs.clone(),
            changes: changes.iter().map(line).collect(),
            unknown: prepared.plan.unknown.clone(),
            restored: Vec::new(),
            left: Vec::new(),
            notes: (set || !noted.is_empty()).then_some(place),
            restart,
        })?;
    } else if set {
        let mut lines = vec![format!("set; what was found stands in {place}")];
        lines.push("after the flight: mavid log prepare --connect ADDRESS --restore puts it back".to_owned());
        if restart {
            lines.push(
                "restart the autopilot now: until then it logs as before. mavid does not restart it"
                    .to_owned(),
            );
        }
        output::text(&lines.join("\n"))?;
    } else if !changes.is_empty() {
        output::text("nothing is changed; --set-logging sets it")?;
    }
    Ok(Outcome::Done)
}

fn says(session: &Session, logs: &[String], changes: &[LogChange], unknown: &[&str]) -> String {
    let mut lines =
        vec![format!("system {}, {}, logs in flight:", session.vehicle.system, session.stack.name)];
    lines.extend(logs.iter().map(|line| format!("  {line}")));
    if !unknown.is_empty() {
        lines.push(format!("not known: {} did not answer", unknown.join(", ")));
    }
    if changes.is_empty() && unknown.is_empty() {
        lines.push("that is enough for an identification".to_owned());
    }
    for change in changes {
        let LogChange { parameter, found, wanted, restarts } = change;
        let restart = if *restarts { ", after a restart of the autopilot" } else { "" };
        let setting =
            session.stack.log_settings.settings.iter().find(|setting| setting.parameter == *parameter);
        let words = setting.map_or("", |setting| setting.words);
        lines.push(format!(
            "for an identification: {parameter} = {wanted} instead of {found}{restart} ({words})"
        ));
    }
    lines.join("\n")
}

/// What is changed, for people.
pub fn changes_page(changes: &[LogChange]) -> String {
    let one =
        |change: &LogChange| format!("{} = {} instead of {}", change.parameter, change.wanted, change.found);
    changes.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// What is said where an earlier run changed something that is not put back.
pub fn earlier(noted: &[Noted]) -> String {
    let list = noted.iter().map(|noted| format!("{} from {} to {}", noted.name, noted.found, noted.set));
    format!(
        "an earlier run changed {} on this vehicle: mavid log prepare --connect ADDRESS --restore puts it back",
        list.collect::<Vec<_>>().join(", ")
    )
}

/// Somebody at a terminal agrees by this word.
pub fn agreed(word: &str, what: &str) -> Result<bool, CommandError> {
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return Ok(false);
    }
    output::message(&format!("type {word} and return to {what}, or return alone to leave it"));
    let mut line = String::new();
    let read = io::stdin().lock().read_line(&mut line);
    read.map_err(|error| CommandError::Failure(format!("cannot read standard input: {error}")))?;
    Ok(line.trim() == word)
}

fn restored(json: bool, session: &Session, put_back: &PutBack) -> Result<Outcome, CommandError> {
    let names: Vec<&str> = put_back.done.iter().map(|noted| noted.name.as_str()).collect();
    let restart = preparing::needs_restart(session, &names);
    if json {
        let line = |name: &str, value: f64| RestoredLine { parameter: name.to_owned(), value };
        output::json(&Document {
            schema: 1,
            system: session.vehicle.system.0,
            autopilot: session.stack.id,
            logs: Vec::new(),
            changes: Vec::new(),
            unknown: Vec::new(),
            restored: put_back.done.iter().map(|noted| line(&noted.name, noted.found)).collect(),
            left: put_back.left.iter().map(|(noted, now)| line(&noted.name, *now)).collect(),
            notes: None,
            restart,
        })?;
    } else {
        output::text(&put_back_page(put_back, restart))?;
    }
    Ok(Outcome::Done)
}

/// What was put back, for people.
pub fn put_back_page(put_back: &PutBack, restart: bool) -> String {
    let mut lines: Vec<String> =
        put_back.done.iter().map(|noted| format!("{} is {} again", noted.name, noted.found)).collect();
    for (noted, now) in &put_back.left {
        lines.push(format!(
            "{} stays {now}: it was set to {}, and somebody changed it since (it was {})",
            noted.name, noted.set, noted.found
        ));
    }
    if lines.is_empty() {
        lines.push("nothing to put back on this vehicle".to_owned());
    } else if restart {
        lines.push("the autopilot logs so after its next start".to_owned());
    }
    lines.join("\n")
}
