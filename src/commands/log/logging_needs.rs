//! What a flight would have to change of the logging, looked at before anybody is asked.

use mavid::onboard;

use super::link::open;
use super::prepare::{changes_page, restart_now, suffices};
use super::state;
use crate::cli::VehicleLinkArgs;
use crate::commands::CommandError;
use crate::commands::network;

/// What a vehicle will log, and what an identification needs beyond.
#[derive(Debug, Clone, Default)]
pub struct LoggingNeeds {
    /// what it will log, in sentences without their ends
    pub logs: Vec<String>,
    /// what is to be changed, in one line; empty: nothing
    pub changes: String,
    /// it counts only after a restart of the autopilot
    pub restarts: bool,
    /// what was set and waits for a restart of the autopilot, in a sentence
    pub awaited: Option<String>,
    /// that what it logs suffices, as far as the vehicle tells
    pub suffices: Option<String>,
    /// what it would log after the changes, in sentences without their ends
    pub would_log: Vec<String>,
    /// this program changed it before, and has not put it back
    pub is_own: bool,
    /// and one of these counts only after a restart of the autopilot, when it is put back as well
    pub own_restarts: bool,
    /// parameters of logging that did not answer
    pub unknown: Vec<&'static str>,
}

/// Asks the vehicle how it logs. Nothing on it is changed.
///
/// # Errors
/// It does not answer.
pub fn logging_needs(link: &VehicleLinkArgs) -> Result<LoggingNeeds, CommandError> {
    network::block_on(async {
        let mut session = open(link).await?;
        let offer = session.offer().await?;
        let notes = state::notes(&session.known_as(&offer))?;
        let state = onboard::look(&mut session, &notes).await?;
        let changes = &state.plan.changes;
        let names: Vec<&str> = changes.iter().map(|change| change.parameter).collect();
        let own: Vec<&str> = state.noted.iter().map(|noted| noted.name.as_str()).collect();
        let needed =
            |name: &str| changes.iter().find(|change| change.parameter == name).map(|change| change.needed);
        Ok(LoggingNeeds {
            would_log: session.stack.log_plan(needed).logs,
            is_own: !own.is_empty(),
            own_restarts: onboard::needs_restart(&session, &own),
            changes: changes_page(&state.plan.changes),
            restarts: onboard::needs_restart(&session, &names),
            awaited: (!state.awaited.is_empty()).then(|| restart_now(&state.awaited)),
            suffices: suffices(&session, &state),
            unknown: state.plan.unknown,
            logs: state.plan.logs,
        })
    })
}
