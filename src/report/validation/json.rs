//! The JSON document of `validate`.

use crate::study::{ErrorTable, InputFile, ValidateStudy};
use serde::Serialize;

/// The JSON document of `validate`.
#[derive(Debug, Clone, Serialize)]
pub struct ValidationDocument {
    schema: u32,
    models: Vec<String>,
    flights: Vec<FlightTables>,
}

#[derive(Debug, Clone, Serialize)]
struct FlightTables {
    input: InputFile,
    /// interval of the closed-loop and prediction errors, s
    span_s: (f64, f64),
    tables: Vec<ErrorTable>,
}

impl ValidationDocument {
    /// The document of a study.
    #[must_use]
    pub fn new(study: &ValidateStudy) -> Self {
        let flights = study.flights.iter().map(|flight| FlightTables {
            input: flight.input.clone(),
            span_s: flight.span_s,
            tables: flight.tables.clone(),
        });
        Self {
            schema: 1,
            models: study.models.iter().map(|model| model.name.clone()).collect(),
            flights: flights.collect(),
        }
    }
}
