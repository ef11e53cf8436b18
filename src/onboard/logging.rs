//! What the autopilot will log, what is changed of it, and how that is put back.

use super::setting::{read, set};
use super::{OnboardError, Session};
use crate::autopilot::{LogAwaited, LogChange, LogPlan};
use crate::fetch::{Known, Moment, Noted, Notes, SetParameters};

/// What a vehicle will log, with its parameters.
#[derive(Debug, Default)]
pub struct LoggingState {
    known: Known,
    /// what it logs, and what should be changed
    pub plan: LogPlan,
    /// what an earlier run changed and did not put back
    pub noted: Vec<Noted>,
    /// of these what waits for a restart of the autopilot
    pub awaited: Vec<LogAwaited>,
    /// of these what waits for one or has had it: the vehicle does not say
    pub unsure: Vec<&'static str>,
}

/// What was put back, or not.
#[derive(Debug, Default)]
pub struct PutBack {
    /// name and value of each parameter that is what it was again
    pub done: Vec<Noted>,
    /// those that somebody changed meanwhile: they stay, with what they are
    pub left: Vec<(Noted, f64)>,
    /// those that are not put back, and why: they stay in the notes
    pub failed: Vec<(Noted, String)>,
    /// the autopilot logs by what was put back only after a restart
    pub restart: bool,
}

/// Asks the vehicle for its parameters of logging, and whether it was restarted since an earlier run set them.
///
/// # Errors
/// It answers for none of them, the notes cannot be read, or those of [`Session::talk`].
pub async fn look(session: &mut Session, notes: &Notes) -> Result<LoggingState, OnboardError> {
    let names: Vec<&'static str> =
        session.stack.log_settings.settings.iter().map(|setting| setting.parameter).collect();
    let known = read(session, &session.stack.log_parameters()).await?;
    if names.iter().all(|name| known.value(name).is_none()) {
        return Err(OnboardError::Unanswered(names));
    }
    let noted = notes.read()?;
    let mut state = LoggingState { known, noted, ..LoggingState::default() };
    wait_for_start(session, &mut state).await?;
    let known = &state.known;
    state.plan = session.stack.log_plan_until_start(|name| known.value(name), &state.awaited);
    Ok(state)
}

/// Which of the noted parameters count only after a restart that has not come.
async fn wait_for_start(session: &mut Session, state: &mut LoggingState) -> Result<(), OnboardError> {
    let settings = session.stack.log_settings.settings.iter().filter(|setting| setting.restarts);
    let set: Vec<(&'static str, &Noted)> = settings
        .filter_map(|setting| {
            let noted = state.noted.iter().find(|noted| noted.name == setting.parameter)?;
            (state.known.value(&noted.name) == Some(noted.set)).then_some((setting.parameter, noted))
        })
        .collect();
    if set.is_empty() {
        return Ok(());
    }
    let now = session.moment().await?;
    let (mut awaited, mut unsure) = (Vec::new(), Vec::new());
    for (parameter, noted) in set {
        match has_restarted(noted, &now) {
            Some(true) => {}
            Some(false) => awaited.push(LogAwaited { parameter, set: noted.set, runs_by: noted.found }),
            None => unsure.push(parameter),
        }
    }
    (state.awaited, state.unsure) = (awaited, unsure);
    Ok(())
}

fn has_restarted(noted: &Noted, now: &Moment) -> Option<bool> {
    noted.at.and_then(|at| at.restarted_until(now))
}

/// Notes what was found, then changes it.
///
/// # Errors
/// The notes cannot be written, the vehicle does not take a value, it is armed, or those of [`Session::talk`].
pub async fn change(
    session: &mut Session,
    state: &LoggingState,
    changes: &[LogChange],
    notes: &Notes,
) -> Result<(), OnboardError> {
    let at = Some(session.moment().await?);
    let noted = |change: &LogChange| Noted {
        name: change.parameter.to_owned(),
        found: change.found,
        set: change.needed,
        became: None,
        at,
    };
    set(session, &state.known, &changes.iter().map(noted).collect::<Vec<_>>(), notes).await
}

/// What happens to a parameter that somebody else changed since.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChangedSince {
    /// it stays, and is no longer noted
    Forgotten,
    /// it stays, and what it was before stays noted
    Kept,
    /// it is put back all the same
    Overwritten,
}

/// Puts back what an earlier run changed, what the vehicle made of it by itself included. What somebody else changed since is
/// treated by `since`. What cannot be put back stays noted.
///
/// # Errors
/// The notes cannot be read or written, the vehicle is armed, or those of [`Session::talk`].
pub async fn put_back(
    session: &mut Session,
    notes: &Notes,
    since: ChangedSince,
) -> Result<PutBack, OnboardError> {
    let noted = notes.read()?;
    let names: Vec<&str> = noted.iter().map(|noted| noted.name.as_str()).collect();
    let known = read(session, &names).await?;
    let mut put_back = PutBack::default();
    let mut wanted = Vec::new();
    for noted in &noted {
        match known.value(&noted.name) {
            Some(now) if noted.is_own(now) => wanted.push(noted),
            // as it was: the run ended before it changed it
            Some(now) if now == noted.found => put_back.done.push(noted.clone()),
            Some(_) if since == ChangedSince::Overwritten => wanted.push(noted),
            Some(now) => put_back.left.push((noted.clone(), now)),
            None => put_back.failed.push((noted.clone(), "the vehicle does not answer for it".to_owned())),
        }
    }
    let values: Vec<(&str, f64)> = wanted.iter().map(|noted| (noted.name.as_str(), noted.found)).collect();
    let mut setting = SetParameters::new(session.vehicle, &known, &values)?;
    if !values.is_empty() {
        session.expect_disarmed().await?;
        session.talk_disarmed(&mut setting).await?;
    }
    let names: Vec<&str> = values.iter().map(|(name, _)| *name).collect();
    if needs_restart(session, &names) {
        let now = session.moment().await?;
        // what the autopilot never started with needs no restart to be gone
        put_back.restart = wanted.iter().any(|noted| has_restarted(noted, &now) != Some(false));
    }
    let failures: Vec<(&str, String)> =
        setting.failures().map(|(name, why)| (name, why.to_string())).collect();
    for noted in wanted {
        match failures.iter().find(|(name, _)| *name == noted.name) {
            Some((_, why)) => put_back.failed.push((noted.clone(), why.clone())),
            None => put_back.done.push(noted.clone()),
        }
    }
    let left = put_back.left.iter().filter(|_| since == ChangedSince::Kept).map(|(noted, _)| noted);
    notes.keep(put_back.failed.iter().map(|(noted, _)| noted).chain(left).cloned().collect())?;
    Ok(put_back)
}

/// Whether the autopilot must start anew for one of these to count.
#[must_use]
pub fn needs_restart(session: &Session, names: &[&str]) -> bool {
    let settings = session.stack.log_settings.settings;
    settings.iter().any(|setting| setting.restarts && names.contains(&setting.parameter))
}
