//! What a run says at its end.

use mavid::fly::{self, Record};
use mavid::report::ExplanationDocument;
use mavid::study::ExplainStudy;
use mavid::text;
use serde::Serialize;

use super::concealed::Compared;
use super::context::Context;
use super::folder::COMMANDS;
use crate::commands::explain::{REPORT, SUMMARY};

/// Everything that a run has made.
pub struct Made<'a> {
    /// of all flights
    pub study: &'a ExplainStudy,
    /// of the last flight of this run; none where all flights were there already
    pub record: Option<&'a Record>,
    /// flights that were explained
    pub flights: usize,
    /// files for simulators
    pub exports: Vec<String>,
    /// parameters for the aircraft itself
    pub parameters: Option<String>,
    /// what was concealed and what was found, if anything was concealed
    pub concealed: Vec<Compared>,
    /// wall clock
    pub took_s: f64,
}

/// The document.
#[derive(Serialize)]
pub struct Document<'a> {
    schema: u32,
    directory: String,
    /// flights that were explained
    flights: usize,
    /// of the last flight of this run
    flight: Option<&'a fly::Outcome>,
    setpoints: Option<fly::StreamFigures>,
    recorded_frames: Option<u64>,
    dropped_frames: Option<u64>,
    explanation: ExplanationDocument,
    report: String,
    model: String,
    exports: Vec<String>,
    /// for the aircraft itself
    parameters: Option<String>,
    /// each step as it is typed
    commands: Vec<String>,
    concealed: Vec<Compared>,
    took_s: f64,
}

impl<'a> Document<'a> {
    /// Of what a run has made.
    pub fn new(context: &Context<'_>, made: Made<'a>) -> Self {
        let record = made.record;
        Self {
            schema: 1,
            directory: text::path(context.folder.path()),
            flights: made.flights,
            flight: record.map(|record| &record.outcome),
            setpoints: record.map(|record| record.stream),
            recorded_frames: record.map(|record| record.recorder.frames),
            dropped_frames: record.map(|record| record.recorder.dropped),
            explanation: ExplanationDocument::new(made.study),
            report: text::path(&context.folder.of(REPORT)),
            model: text::path(&context.folder.of("model.toml")),
            exports: made.exports,
            parameters: made.parameters,
            commands: context.steps(),
            concealed: made.concealed,
            took_s: made.took_s,
        }
    }
}

/// The lines on where everything is.
pub fn places(context: &Context<'_>, made: &Made<'_>) -> String {
    let place = |name: &str| text::path(&context.folder.of(name));
    let mut lines = vec![
        format!("report      {}", place(REPORT)),
        format!("summary     {} (to paste into a forum or an issue)", place(SUMMARY)),
        format!("model       {}", place("model.toml")),
    ];
    if !made.exports.is_empty() {
        lines.push(format!("simulators  {} ({} files)", place("export"), made.exports.len()));
    }
    lines.extend(made.parameters.iter().map(|file| format!("aircraft    {file}")));
    let steps = match context.folder.remembered() {
        // they could not be written
        0 => context.steps().len(),
        steps => steps,
    };
    lines.push(format!(
        "commands    {} ({steps} steps, each of which can be repeated alone)",
        place(COMMANDS)
    ));
    let flights = if made.flights == 1 { "1 flight".to_owned() } else { format!("{} flights", made.flights) };
    lines.push(format!("{flights}, {:.0} s", made.took_s));
    lines.join("\n")
}
