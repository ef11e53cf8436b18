//! Whether flights are of the vehicle that is given.

use super::anchor::apply_anchor;
use super::identify::{IdentifySettings, identify};
use super::plausible::{Contradiction, contradictions};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// What identification finds far from what the vehicle file states; nothing where it finds nothing.
#[must_use]
pub fn contradicted(flights: &[Signals], vehicle: &Vehicle) -> Vec<Contradiction> {
    let Ok(mut found) = identify(flights, vehicle, &IdentifySettings::default()) else { return Vec::new() };
    let scale = apply_anchor(&mut found, vehicle);
    contradictions(&found.best.result, vehicle, scale.as_ref())
}
