//! The logging for several flights: set before the first one, with a restart of the autopilot, and put back after the last one.

use mavid::onboard::{self, ChangedSince};

use super::before::AFTER;
use super::link::{open, open_patiently};
use super::prepare::{changes_page, expect_rates, put_back_page};
use super::restart::restart;
use super::state;
use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network, output};

/// Sets what an identification needs, and restarts the autopilot for it.
///
/// # Errors
/// It does not answer or take the values, or those of the restart: what was set stays set, and noted.
pub fn set_and_restart(link: &VehicleLinkArgs) -> Result<(), CommandError> {
    network::block_on(async {
        let mut session = open(link).await?;
        let offer = session.offer().await?;
        let notes = state::notes(&session.known_as(&offer))?;
        let state = onboard::look(&mut session, &notes).await?;
        expect_rates(&session, &state)?;
        let changes = &state.plan.changes;
        if !changes.is_empty() {
            onboard::change(&mut session, &state, changes, &notes).await?;
            output::message(&format!("logging: {} is set", changes_page(changes)));
        }
        restart(session, link).await
    })
}

/// Puts back what was changed of the logging, line by line what it was. That it cannot be put back is an error.
///
/// # Errors
/// The vehicle does not answer or take the values.
pub fn put_back_now(link: &VehicleLinkArgs) -> Result<Vec<String>, CommandError> {
    network::block_on(async {
        let mut session = open_patiently(link, AFTER).await?;
        let offer = session.offer().await?;
        let notes = state::notes(&session.known_as(&offer))?;
        let put_back = onboard::put_back(&mut session, &notes, ChangedSince::Forgotten).await?;
        let page = put_back_page(&put_back);
        if put_back.failed.is_empty() {
            return Ok(page.lines().map(str::to_owned).collect());
        }
        Err(CommandError::Failure(page.replace('\n', "; ")))
    })
}
