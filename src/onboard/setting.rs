//! Parameters of a vehicle, read and set over its link.

use super::{Flow, OnboardError, Session};
use crate::fetch::{Known, Noted, Notes, ReadParameters, SetParameters};

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
