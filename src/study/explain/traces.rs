//! The flights as the weak form sees them.

use crate::diagnose::{ExplainSettings, Trace};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// The flights as the weak form sees them; those that it cannot see are left out.
pub(super) fn traces_of(flights: &[Signals], vehicle: &Vehicle, settings: &ExplainSettings) -> Vec<Trace> {
    flights.iter().filter_map(|signals| Trace::new(signals, vehicle, settings.half_width_s).ok()).collect()
}
