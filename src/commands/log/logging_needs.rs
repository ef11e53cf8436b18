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
        let names: Vec<&str> = state.plan.changes.iter().map(|change| change.parameter).collect();
        Ok(LoggingNeeds {
            changes: changes_page(&state.plan.changes),
            restarts: onboard::needs_restart(&session, &names),
            awaited: (!state.awaited.is_empty()).then(|| restart_now(&state.awaited)),
            suffices: suffices(&session, &state),
            unknown: state.plan.unknown,
            logs: state.plan.logs,
        })
    })
}
