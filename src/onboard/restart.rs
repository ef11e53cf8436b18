//! An autopilot that starts anew.

use super::{OnboardError, Session};
use crate::fetch::{Moment, Restart};

/// Orders the autopilot to start anew, while it is disarmed; when that was ordered. The link may be gone afterwards.
///
/// # Errors
/// It is armed or refuses, or those of [`Session::talk`].
pub async fn order_restart(session: &mut Session) -> Result<Moment, OnboardError> {
    let ordered = session.moment().await?;
    session.expect_disarmed().await?;
    let mut restart = Restart::new(session.vehicle)?;
    session.talk_disarmed(&mut restart).await?;
    restart.obeyed()?;
    Ok(ordered)
}
