//! A flight and what was made of it, as JSON.

use std::path::Path;

use mavid::fly::{self, Outcome as FlightOutcome, Record};
use mavid::report::{ExplanationDocument, IdentificationDocument};
use mavid::text;
use serde::Serialize;

use crate::commands::after_flight::Analysis;

/// What was flown and what it says.
#[derive(Serialize)]
pub struct Document {
    schema: u32,
    directory: String,
    flight: FlightOutcome,
    setpoints: fly::StreamFigures,
    /// frames of the recording, and those that it lost
    recorded_frames: u64,
    dropped_frames: u64,
    /// `None` where the flight says nothing
    identification: Option<IdentificationDocument>,
    /// why there is none, or why it is in no file
    identification_failure: Option<String>,
    explanation: Option<ExplanationDocument>,
    /// the same
    explanation_failure: Option<String>,
    report: Option<String>,
    /// the vehicle's own log, where it is what was analysed
    #[serde(skip_serializing_if = "Option::is_none")]
    onboard_log: Option<String>,
}

impl Document {
    /// Of a flight recorded in a folder; without an analysis it did not land.
    pub fn new(record: &Record, folder: &Path, analysis: Option<&Analysis>) -> Self {
        let identified = analysis.map(|analysis| &analysis.identified);
        let explained = analysis.map(|analysis| &analysis.explained);
        let unwritten = |part: usize| analysis.and_then(|analysis| analysis.unwritten[part].clone());
        Self {
            schema: 1,
            directory: text::path(&folder),
            flight: record.outcome.clone(),
            setpoints: record.stream,
            recorded_frames: record.recorder.frames,
            dropped_frames: record.recorder.dropped,
            identification: identified.and_then(|done| done.as_ref().ok()).map(IdentificationDocument::new),
            identification_failure: identified.and_then(|done| done.as_ref().err()).cloned().or(unwritten(0)),
            explanation: explained.and_then(|done| done.as_ref().ok()).map(ExplanationDocument::new),
            explanation_failure: explained.and_then(|done| done.as_ref().err()).cloned().or(unwritten(1)),
            report: analysis.and_then(Analysis::report).map(|path| text::path(&path)),
            onboard_log: analysis.and_then(|analysis| analysis.onboard.as_ref()).map(text::path),
        }
    }
}
