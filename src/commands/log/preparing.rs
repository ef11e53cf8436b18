//! What the autopilot will log, what is changed of it, and how that is put back.

use mavid::autopilot::{LogChange, LogPlan};
use mavid::fetch::{Known, Noted, Notes, ReadParameters, SetParameters};

use super::session::{Flow, Session};
use crate::commands::CommandError;

/// What a vehicle will log, with its parameters.
#[derive(Debug)]
pub struct Prepared {
    known: Known,
    /// what it logs, and what should be changed
    pub plan: LogPlan,
}

/// What was put back, or not.
#[derive(Debug, Default)]
pub struct PutBack {
    /// name and value of each parameter that is what it was again
    pub done: Vec<Noted>,
    /// those that somebody changed meanwhile: they stay, with what they are
    pub left: Vec<(Noted, f64)>,
}

fn failed(error: impl std::fmt::Display) -> CommandError {
    CommandError::Failure(error.to_string())
}

/// Asks the vehicle for its parameters of logging.
pub async fn look(session: &mut Session) -> Result<Prepared, CommandError> {
    let names: Vec<&str> =
        session.stack.log_settings.settings.iter().map(|setting| setting.parameter).collect();
    let known = read(session, &names).await?;
    let plan = session.stack.log_plan(|name| known.value(name));
    if names.iter().all(|name| known.value(name).is_none()) {
        return Err(CommandError::Failure(format!(
            "expected an answer for {}, the vehicle gave none",
            names.join(", ")
        )));
    }
    Ok(Prepared { known, plan })
}

async fn read(session: &mut Session, names: &[&str]) -> Result<Known, CommandError> {
    let mut reading = ReadParameters::new(session.vehicle, names).map_err(failed)?;
    session.talk(&mut reading, |_| Ok(Flow::On)).await?;
    Ok(reading.known())
}

/// Notes what was found, then changes it.
pub async fn change(
    session: &mut Session,
    prepared: &Prepared,
    changes: &[LogChange],
    notes: &Notes,
) -> Result<(), CommandError> {
    let noted = |change: &LogChange| Noted {
        name: change.parameter.to_owned(),
        found: change.found,
        set: change.wanted,
    };
    notes.add(&changes.iter().map(noted).collect::<Vec<_>>()).map_err(failed)?;
    let wanted: Vec<(&str, f64)> = changes.iter().map(|change| (change.parameter, change.wanted)).collect();
    let mut setting = SetParameters::new(session.vehicle, &prepared.known, &wanted).map_err(failed)?;
    session.talk_disarmed(&mut setting).await?;
    Ok(())
}

/// Puts back what an earlier run changed, as far as nobody else changed it since.
pub async fn put_back(session: &mut Session, notes: &Notes) -> Result<PutBack, CommandError> {
    let noted = notes.read().map_err(failed)?;
    let names: Vec<&str> = noted.iter().map(|noted| noted.name.as_str()).collect();
    let known = read(session, &names).await?;
    let mut put_back = PutBack::default();
    let mut wanted = Vec::new();
    for noted in &noted {
        match known.value(&noted.name) {
            Some(now) if now == noted.set => {
                wanted.push((noted.name.as_str(), noted.found));
                put_back.done.push(noted.clone());
            }
            // as it was: the run ended before it changed it
            Some(now) if now == noted.found => put_back.done.push(noted.clone()),
            Some(now) => put_back.left.push((noted.clone(), now)),
            None => {
                return Err(CommandError::Failure(format!(
                    "expected the value of {}, the vehicle does not answer: it is not put back yet",
                    noted.name
                )));
            }
        }
    }
    let mut setting = SetParameters::new(session.vehicle, &known, &wanted).map_err(failed)?;
    session.talk_disarmed(&mut setting).await?;
    notes.forget().map_err(failed)?;
    Ok(put_back)
}

/// Whether the autopilot must start anew for one of these to count.
pub fn needs_restart(session: &Session, names: &[&str]) -> bool {
    let settings = session.stack.log_settings.settings;
    settings.iter().any(|setting| setting.restarts && names.contains(&setting.parameter))
}
