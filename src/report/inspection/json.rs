//! The JSON document of `inspect`.

use crate::inspect::Inspection;
use serde::Serialize;

/// The JSON document of `inspect`: `{"schema": 1, "file": ..., ...}` with the fields of [`Inspection`]. Keys carry their
/// unit, times are seconds of the vehicle's clock from the recording's start, and what is not known is `null`.
#[derive(Debug, Serialize)]
pub struct InspectionDocument<'a> {
    schema: u32,
    file: &'a str,
    #[serde(flatten)]
    inspection: &'a Inspection,
}

impl<'a> InspectionDocument<'a> {
    /// The document of the log of this name.
    #[must_use]
    pub fn new(file: &'a str, inspection: &'a Inspection) -> Self {
        Self { schema: 1, file, inspection }
    }
}
