//! The result of validating: errors of every model on every flight.

use super::error_table::ErrorTable;
use crate::compare::TenSignals;
use crate::note::Note;
use crate::signals::Quality;
use crate::study::InputFile;

/// The whole answer.
#[derive(Debug)]
pub struct ValidateStudy {
    /// the first is what the others are compared with
    pub models: Vec<ValidatedModel>,
    /// one entry a flight
    pub flights: Vec<ValidatedFlight>,
    /// s left out at the beginning of each flight
    pub transient_s: f64,
    /// Hz, of the low-pass under the regression models
    pub cutoff_hz: f64,
    /// what is doubtful about the models' files
    pub notes: Vec<Note>,
}

/// A model by its file.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidatedModel {
    /// the file's name, or its path where two files have one name
    pub name: String,
    /// the file
    pub input: InputFile,
}

/// What the models make of one flight.
#[derive(Debug)]
pub struct ValidatedFlight {
    /// its file
    pub input: InputFile,
    /// s, interval of the closed-loop and prediction errors
    pub span_s: (f64, f64),
    /// closed loop, then prediction by both regression models, then playback by length of window
    pub tables: Vec<ErrorTable>,
    /// recorded, then flown again by each model that could; none where no model could
    pub flown_again: Vec<(String, TenSignals)>,
    /// where its signals come from, by the first model's thrust law
    pub quality: Quality,
}
