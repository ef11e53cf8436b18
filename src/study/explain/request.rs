//! What is to be explained.

use std::path::PathBuf;

use crate::study::{ReadSettings, StudyError, VehicleGiven};

/// What is to be explained, and what it is to be shown on.
#[derive(Debug, Clone, Default)]
pub struct ExplainRequest {
    /// recordings of one vehicle
    pub logs: Vec<PathBuf>,
    /// its file, or its mass and size, whose effects are removed and searched for again if it is a model
    pub vehicle: VehicleGiven,
    /// other flights of it, on which the improvement is shown; without them the end of the last flight is held back
    pub holdout: Vec<PathBuf>,
    /// how the recordings are read
    pub read: ReadSettings,
    /// time left out at the beginning of the flight, s
    pub transient_s: f64,
    /// design the flight that distinguishes best what these cannot
    pub design_next: bool,
    /// file with the limits of that flight; `None`: the vehicle's own
    pub next_limits: Option<PathBuf>,
}

impl ExplainRequest {
    /// time left out at the beginning of the flight, s unless asked otherwise.
    pub const TRANSIENT_S: f64 = 1.0;

    /// Checks what can be checked before a file is read.
    ///
    /// # Errors
    /// [`StudyError::Setting`].
    pub fn check(&self) -> Result<(), StudyError> {
        check_transient(self.transient_s)?;
        self.read.check(self.logs.iter().chain(&self.holdout))
    }
}

/// # Errors
/// [`StudyError::Setting`] where the time is below zero or not finite.
pub(in crate::study) fn check_transient(transient_s: f64) -> Result<(), StudyError> {
    if transient_s.is_finite() && transient_s >= 0.0 {
        return Ok(());
    }
    let why = format!("expected seconds from 0 on, got {transient_s}");
    Err(StudyError::Setting { name: "transient", why })
}
