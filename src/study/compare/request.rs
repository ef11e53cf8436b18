//! Which flights are compared.

use std::path::PathBuf;

use crate::autopilot::Frame;
use crate::study::explain::check_transient;
use crate::study::{ExplainRequest, ReadSettings, StudyError, VehicleGiven};

/// Which flights are compared.
#[derive(Debug, Clone, Default)]
pub struct CompareRequest {
    /// earlier recordings of one vehicle, or all of them in order
    pub before: Vec<PathBuf>,
    /// later ones; empty: only the history of all is told
    pub after: Vec<PathBuf>,
    /// its file, or its mass and size; `None`: nothing is known but the autopilot's frame, and results are shares
    pub vehicle: Option<VehicleGiven>,
    /// where the motors are, if neither [`Self::vehicle`] nor the first log says so
    pub frame: Option<&'static Frame>,
    /// how the recordings are read
    pub read: ReadSettings,
    /// time left out at the beginning of each flight, s
    pub transient_s: f64,
    /// compare the balance alone, not what the motion shows
    pub balance_only: bool,
}

impl CompareRequest {
    /// Time left out at the beginning of each flight, s, unless asked otherwise.
    pub const TRANSIENT_S: f64 = ExplainRequest::TRANSIENT_S;

    /// Checks what can be checked before a file is read.
    ///
    /// # Errors
    /// [`StudyError::Setting`].
    pub fn check(&self) -> Result<(), StudyError> {
        check_transient(self.transient_s)?;
        if self.before.is_empty() || self.before.len() + self.after.len() < 2 {
            let why =
                "expected at least two recordings: one before --with and one after it, or a row of them"
                    .to_owned();
            return Err(StudyError::Setting { name: "with", why });
        }
        self.read.check(self.before.iter().chain(&self.after))
    }
}
