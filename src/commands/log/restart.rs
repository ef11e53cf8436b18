//! A restart of the autopilot, for logging that counts only then.

use std::time::{Duration, Instant};

use mavid::onboard::{self, Session};

use super::link::open_patiently;
use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, output};

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
