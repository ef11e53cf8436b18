//! Which models are compared with which flights.

use std::path::PathBuf;

use crate::draft::Given;
use crate::study::explain::check_transient;
use crate::study::{ReadSettings, StudyError};

/// Which models are compared with which flights.
#[derive(Debug, Clone, Default)]
pub struct ValidateRequest {
    /// recordings of one vehicle
    pub logs: Vec<PathBuf>,
    /// vehicle or model files; the first is what the others are compared with
    pub models: Vec<PathBuf>,
    /// a vehicle that is drafted from the first log, before all of them
    pub drafted: Option<Given>,
    /// how the recordings are read
    pub read: ReadSettings,
    /// time left out at the beginning of the flight, s
    pub transient_s: f64,
}

impl ValidateRequest {
    /// Checks what can be checked before a file is read.
    ///
    /// # Errors
    /// [`StudyError::Setting`].
    pub fn check(&self) -> Result<(), StudyError> {
        if self.models.is_empty() && self.drafted.is_none() {
            return Err(StudyError::Setting { name: "model", why: "expected at least one".to_owned() });
        }
        check_transient(self.transient_s)
    }
}
