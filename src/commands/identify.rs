//! `mavid identify LOG... --vehicle V`: parameters from recorded flights.

use std::path::PathBuf;

use mavid::report::{
    IdentificationDocument, history_charts, identification_html, identification_text, identified_model, svg,
};
use mavid::study::{IdentifyRequest, IdentifyStudy, InputFile, identify, lost, said_of};

use super::progress::Spinner;
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::IdentifyArgs;

/// Where results go.
#[derive(Debug, Default)]
pub struct Targets {
    /// the identified vehicle
    pub model: Option<PathBuf>,
    /// the report
    pub report: Option<PathBuf>,
    /// the parameters over time
    pub chart: Option<PathBuf>,
}

impl Targets {
    /// As asked for; the report beside the model.
    fn of(args: &IdentifyArgs) -> Self {
        let beside = || args.out.as_ref().map(|model| model.with_extension("html"));
        let report = args.report.clone().or_else(beside);
        Self { model: args.out.clone(), report, chart: args.chart.clone() }
    }

    fn all(&self) -> Vec<&PathBuf> {
        self.model.iter().chain(&self.chart).chain(&self.report).collect()
    }

    /// Writes what there is a place for.
    pub fn write(&self, study: &IdentifyStudy) -> Result<(), CommandError> {
        if let Some(path) = &self.report {
            output::file(path, &identification_html(study))?;
        }
        if let Some(path) = &self.chart {
            output::file(path, &svg(&history_charts(&study.identification)))?;
        }
        // last: it is refused where what was determined is no body's
        if let Some(path) = &self.model {
            output::file(path, &identified_model(study)?)?;
        }
        Ok(())
    }
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &IdentifyArgs) -> Result<Outcome, CommandError> {
    let (study, targets) = make(stderr, args)?;
    if json {
        output::json(&IdentificationDocument::new(&study))?;
    } else {
        output::text(&identification_text(&study))?;
    }
    targets.write(&study)?;
    Ok(tell(study.inputs.iter()))
}

/// Identifies, and says where that is to be written.
pub fn make(stderr: &StandardError, args: &IdentifyArgs) -> Result<(IdentifyStudy, Targets), CommandError> {
    let request = IdentifyRequest {
        logs: args.logs.clone(),
        vehicle: args.given.given(),
        read: args.read.settings(),
        transient_s: args.transient,
        cutoff_hz: args.cutoff,
        fir: args.fir,
        sigma: args.sigma,
        by_commands: args.commands,
        with: args.with.clone(),
    };
    let targets = Targets::of(args);
    let inputs: Vec<&PathBuf> = args.logs.iter().chain(&args.given.vehicle).collect();
    output::refuse_overwriting(&inputs, &targets.all())?;
    let study = identify(&request, &Spinner::new(stderr))?;
    Ok((study, targets))
}

/// Says what is to be known of the logs, and what of them was lost; the same of several once.
pub fn tell<'a>(inputs: impl Iterator<Item = &'a InputFile>) -> Outcome {
    let inputs: Vec<&InputFile> = inputs.collect();
    said_of(inputs.iter().copied()).iter().for_each(output::note);
    if lost(inputs).is_empty() { Outcome::Done } else { Outcome::DoneWithLoss }
}
