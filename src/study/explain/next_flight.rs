//! The next flight as a file of a trajectory.

use crate::config::StoredTrajectory;
use crate::diagnose::experiment::NextFlight;
use std::collections::BTreeMap;

/// The trajectory with its limits, and what the flight distinguishes.
#[must_use]
pub fn stored_trajectory(next: &NextFlight) -> StoredTrajectory {
    StoredTrajectory {
        series: next.trajectory.clone(),
        repeats: next.repeats,
        limits: next.limits,
        criterion: next.pairs.first().map(|pair| ("t_optimality_sigma".to_owned(), pair.after)),
        margins: BTreeMap::new(),
        standard_errors: BTreeMap::new(),
        transitions: None,
    }
}
