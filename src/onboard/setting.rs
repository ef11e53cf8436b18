//! Parameters of a vehicle, read and set over its link.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::{Flow, OnboardError, Session};
use crate::fetch::{Dialogue, FetchError, Known, Noted, Notes, ReadParameters, SetParameters};
use crate::wire::Frame;

/// What the vehicle says of these parameters.
pub(super) async fn read(session: &mut Session, names: &[&str]) -> Result<Known, OnboardError> {
    let mut reading = ReadParameters::new(session.vehicle, names)?;
    session.talk(&mut reading, |_| Ok(Flow::On)).await?;
    Ok(reading.known())
}

/// Notes what was found, then sets it, while the vehicle is disarmed.
pub(super) async fn set(
    session: &mut Session,
    known: &Known,
    changes: &[Noted],
    notes: &Notes,
) -> Result<(), OnboardError> {
    session.expect_disarmed().await?;
    notes.add(changes)?;
    let wanted: Vec<(&str, f64)> = changes.iter().map(|change| (change.name.as_str(), change.set)).collect();
    let mut setting = SetParameters::new(session.vehicle, known, &wanted)?;
    session.talk_disarmed(&mut setting).await?;
    let failures: Vec<_> = setting.failures().map(|(_, why)| why).collect();
    if failures.is_empty() { Ok(()) } else { Err(OnboardError::NotSet(failures)) }
}

/// Lets time pass, in which the link is kept.
pub(super) async fn rest(session: &mut Session, time: Duration) -> Result<(), OnboardError> {
    let mut rest = Rest { until: session.elapsed() + time, is_over: false };
    session.talk(&mut rest, |_| Ok(Flow::On)).await.map(|_| ())
}

/// Says nothing and hears nothing.
struct Rest {
    until: Duration,
    is_over: bool,
}

impl Dialogue for Rest {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        self.is_over |= now >= self.until;
        Ok(None)
    }

    fn take(&mut self, _now: Duration, _frame: &Frame<'_>) {}

    fn is_done(&self) -> bool {
        self.is_over
    }
}
