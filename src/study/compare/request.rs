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
        let came = match (self.before.len(), self.after.len()) {
            (0, 0) => "got no log",
            (0, _) => "got none before --with",
            (1, 0) => "got one log",
            _ => return self.read.check(self.before.iter().chain(&self.after)),
        };
        Err(StudyError::TooFewFlights { came: came.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_log_alone_is_told_what_a_comparison_needs() {
        let of = |before: usize, after: usize| CompareRequest {
            before: vec![PathBuf::from("a.bin"); before],
            after: vec![PathBuf::from("b.bin"); after],
            ..CompareRequest::default()
        };
        let said = |request: &CompareRequest| request.check().unwrap_err().to_string();
        let how = "give two logs or more for a history, or BEFORE --with AFTER";
        assert_eq!(said(&of(1, 0)), format!("expected at least two flights, got one log: {how}"));
        assert_eq!(said(&of(0, 2)), format!("expected at least two flights, got none before --with: {how}"));
        assert!(of(2, 0).check().is_ok() && of(1, 1).check().is_ok());
    }
}
