//! Logging that counts only after a restart of the autopilot: set, restarted, and put back.

use std::time::{Duration, Instant};

use mavid::onboard::{self, ChangedSince, Session};

use super::link::{open, open_patiently};
use super::prepare::{changes_page, expect_rates, put_back_page};
use super::state;
use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network, output};

/// An autopilot that was restarted is back within this.
const BACK: Duration = Duration::from_secs(60);
/// Between two looks at whether it is.
const LOOK: Duration = Duration::from_secs(1);

/// Restarts the autopilot, and waits until it says that it has started anew.
///
/// # Errors
/// It is armed, it refuses, or it is not back in time.
pub async fn restart(mut session: Session, link: &VehicleLinkArgs) -> Result<(), CommandError> {
    let ordered = onboard::order_restart(&mut session).await?;
    let link = VehicleLinkArgs { system_id: Some(session.vehicle.system.0), ..link.clone() };
    // its address is needed again
    drop(session);
    output::message(&format!("the autopilot restarts; it is waited for, {} s at most", BACK.as_secs()));
    let until = Instant::now() + BACK;
    while Instant::now() < until {
        tokio::time::sleep(LOOK).await;
        let left = until.saturating_duration_since(Instant::now());
        let mut session = match open_patiently(&link, left).await {
            Err(error @ CommandError::Ended(_)) => return Err(error),
            Err(_) => continue,
            Ok(session) => session,
        };
        if ordered.restarted_until(&session.moment().await?) == Some(true) {
            return Ok(());
        }
    }
    Err(CommandError::Failure(format!(
        "the autopilot was told to restart: expected it back within {} s with a time since its start that says so",
        BACK.as_secs()
    )))
}

/// Sets what an identification needs, and restarts the autopilot for it.
///
/// # Errors
/// It does not answer or take the values, or those of [`restart`]: what was set stays set, and noted.
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
        let mut session = open_patiently(link, super::before::AFTER).await?;
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
