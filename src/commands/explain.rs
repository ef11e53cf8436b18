//! `mavid explain LOG... --vehicle V`: which physics the model left out.

use std::path::{Path, PathBuf};

use mavid::config::read_vehicle;
use mavid::diagnose::{ExplainSettings, explain, period_s};
use mavid::report::{ExplanationDocument, Given, InputFile, ShownOn, Story, explanation_page, held_back};
use mavid::signals::{ConditionSettings, Signals, ThrustPreference, condition};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

use super::effects::effects;
use super::flights::{ReadAs, is_csv, load, refuse_twins};
use super::{CommandError, Outcome, output};
use crate::cli::ExplainArgs;

/// Runs the verb.
pub fn run(json: bool, args: &ExplainArgs) -> Result<Outcome, CommandError> {
    check(args)?;
    let loaded = read_vehicle(&args.vehicle)?;
    let vehicle = loaded.vehicle;
    let mut warnings = loaded.warnings;
    let refuse =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", args.vehicle.display()));
    let known = effects(&loaded.model.effects, &vehicle).map_err(|error| refuse(&error))?;
    let (mut flights, inputs) = conditioned(&args.logs, args, &vehicle)?;
    let (mut shown, held_inputs) = conditioned(&args.holdout, args, &vehicle)?;
    refuse_twins(&inputs.iter().chain(&held_inputs).collect::<Vec<_>>())?;
    let mut shown_on = ShownOn::Flights(held_inputs);
    if args.holdout.is_empty() {
        (shown_on, shown) = hold_back(&mut flights);
    }
    let settings = ExplainSettings::default();
    let explanation = explain(&flights, &vehicle, &settings).map_err(|error| {
        CommandError::Input(format!(
            "{}: {error}",
            args.logs.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ")
        ))
    })?;
    warnings.extend(inputs.iter().flat_map(losses));
    let quality = flights.iter().map(|signals| signals.quality.clone()).collect();
    let given = Given { vehicle, known, inputs, quality, settings, transient_s: args.transient, warnings };
    let mut story = Story::new(given, explanation);
    show(&mut story, &flights, &shown, shown_on);
    if let Some(folder) = &args.out {
        write(folder, &story)?;
    }
    if json {
        output::json(&ExplanationDocument::new(&story))?;
    } else {
        output::text(explanation_page(&story).trim_end())?;
    }
    for warning in &story.given.warnings {
        output::message(&format!("warning: {warning}"));
    }
    let lossless = story.given.inputs.iter().all(|input| input.losses.is_empty());
    Ok(if lossless { Outcome::Done } else { Outcome::DoneWithLoss })
}

fn check(args: &ExplainArgs) -> Result<(), CommandError> {
    let transient_s = args.transient;
    if !transient_s.is_finite() || transient_s < 0.0 {
        return Err(CommandError::Input(format!(
            "--transient: expected seconds from 0 on, got {transient_s}"
        )));
    }
    if args.csv_map.is_some() && !args.logs.iter().chain(&args.holdout).any(|log| is_csv(log)) {
        return Err(CommandError::Input("--csv-map: expected a .csv among the logs, got none".into()));
    }
    if let Some(path) = args.out.as_ref().filter(|path| path.exists() && !path.is_dir()) {
        return Err(CommandError::Input(format!("--out: expected a folder, {} is a file", path.display())));
    }
    Ok(())
}

/// Loads and conditions every flight, side by side.
fn conditioned(
    logs: &[PathBuf],
    args: &ExplainArgs,
    vehicle: &Vehicle,
) -> Result<(Vec<Signals>, Vec<InputFile>), CommandError> {
    let read_as = ReadAs { csv_map: args.csv_map.as_ref(), system: args.system };
    let settings = ConditionSettings {
        transient_s: Some(args.transient),
        thrust: ThrustPreference::BestSampled,
        ..ConditionSettings::default()
    };
    let one = |path: &PathBuf| {
        let flight = load(path, &read_as)?;
        let signals = condition(&flight.recording, vehicle, &settings)
            .map_err(|error| CommandError::Input(format!("{}: {error}", path.display())))?;
        Ok((signals, flight.input))
    };
    let done: Vec<Result<(Signals, InputFile), CommandError>> = logs.par_iter().map(one).collect();
    Ok(done.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

/// The last flight where there are several, else the end of the only one.
fn hold_back(flights: &mut [Signals]) -> (ShownOn, Vec<Signals>) {
    let Some(last) = flights.last_mut() else {
        return (ShownOn::Nothing { reason: "no flight".to_owned() }, Vec::new());
    };
    let Some((explained, shown, from_s)) = held_back(last, flown_period_s(last)) else {
        let reason = "the flight is too short to hold a part of it back; give another flight with --holdout";
        return (ShownOn::Nothing { reason: reason.to_owned() }, Vec::new());
    };
    *last = explained;
    let seconds = shown.usable.iter().filter(|used| **used).count() as f64 * shown.grid.step_s;
    (ShownOn::HeldBack { from_s, seconds }, vec![shown])
}

/// Of the recorded motion.
fn flown_period_s(signals: &Signals) -> Option<f64> {
    let every = mavid::signals::stride(signals.grid.step_s);
    let used: Vec<usize> =
        (0..signals.grid.count).step_by(every.max(1)).filter(|&index| signals.usable[index]).collect();
    let time_s: Vec<f64> = used.iter().map(|&index| signals.grid.time_s(index)).collect();
    let motion = signals.velocity.as_ref().or(signals.rate.as_ref())?;
    let axes: Vec<Vec<f64>> =
        (0..3).map(|axis| used.iter().map(|&index| motion[index][axis]).collect()).collect();
    let axes: Vec<&[f64]> = axes.iter().map(Vec::as_slice).collect();
    period_s(&time_s, &axes)
}

/// Prediction errors before and after.
fn show(story: &mut Story, flights: &[Signals], shown: &[Signals], shown_on: ShownOn) {
    story.shown_on = shown_on;
    match story.played(flights) {
        Ok(pair) => story.identify = Some(pair),
        Err(error) => story.given.warnings.push(format!("open-loop prediction: {error}")),
    }
    if shown.is_empty() {
        return;
    }
    match story.played(shown) {
        Ok(pair) => story.holdout = Some(pair),
        Err(error) => story.shown_on = ShownOn::Nothing { reason: error.to_string() },
    }
    if matches!(story.shown_on, ShownOn::Flights(_)) {
        story.given.warnings.extend(story.stranger(shown));
    }
}

fn losses(input: &InputFile) -> Option<String> {
    (!input.losses.is_empty()).then(|| format!("{}: {}", input.path, input.losses.join("; ")))
}

fn write(folder: &Path, story: &Story) -> Result<(), CommandError> {
    std::fs::create_dir_all(folder)
        .map_err(|error| CommandError::Input(format!("cannot make {}: {error}", folder.display())))?;
    output::file(&folder.join("model.toml"), &story.model_toml()?)?;
    let document = serde_json::to_string_pretty(&ExplanationDocument::new(story))
        .map_err(|error| CommandError::Failure(format!("cannot write JSON: {error}")))?;
    output::file(&folder.join("explanation.json"), &document)
}
