//! `mavid identify LOG... --vehicle V`: parameters from recorded flights.

use mavid::config::{LoadedVehicle, read_vehicle};
use mavid::estimate::{IdentifySettings, apply_anchor, identify};
use mavid::report::{
    IdentificationDocument, InputFile, history_charts, identification_page, model_toml, svg,
};
use mavid::signals::{ConditionSettings, Quality, Signals, ThrustPreference, condition};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

use super::flights::{ReadAs, is_csv, load, refuse_twins};
use super::{CommandError, Outcome, output};
use crate::cli::IdentifyArgs;

/// Runs the verb.
pub fn run(json: bool, args: &IdentifyArgs) -> Result<Outcome, CommandError> {
    let LoadedVehicle { vehicle, warnings, .. } = read_vehicle(&args.vehicle)?;
    for warning in &warnings {
        output::message(&format!("warning: {}: {warning}", args.vehicle.display()));
    }
    let settings = settings(args)?;
    let (flights, inputs) = conditioned(args, &vehicle)?;
    let mut identification =
        identify(&flights, &vehicle, &settings).map_err(|error| CommandError::Input(error.to_string()))?;
    let scale = apply_anchor(&mut identification, &vehicle);
    let quality: Vec<&Quality> = flights.iter().map(|signals| &signals.quality).collect();
    if json {
        let document =
            IdentificationDocument::new(&identification, &vehicle, &quality, &inputs, scale.as_ref());
        output::json(&document)?;
    } else {
        output::text(identification_page(&identification, &vehicle, &quality, scale.as_ref()).trim_end())?;
    }
    if let Some(path) = &args.out {
        let text = model_toml(&identification, &vehicle, &inputs, scale.as_ref())?;
        output::file(path, &text)?;
    }
    if let Some(path) = &args.chart {
        output::file(path, &svg(&history_charts(&identification)))?;
    }
    let mut outcome = Outcome::Done;
    for input in inputs.iter().filter(|input| !input.losses.is_empty()) {
        output::message(&format!("{}: {}", input.path, input.losses.join("; ")));
        outcome = Outcome::DoneWithLoss;
    }
    Ok(outcome)
}

fn settings(args: &IdentifyArgs) -> Result<IdentifySettings, CommandError> {
    for (name, value) in [("--sigma", Some(args.sigma)), ("--cutoff", args.cutoff)] {
        if let Some(value) = value.filter(|value| !value.is_finite() || *value <= 0.0) {
            return Err(CommandError::Input(format!("{name}: expected a positive number, got {value}")));
        }
    }
    if let Some(value) = args.transient.filter(|value| !value.is_finite() || *value < 0.0) {
        return Err(CommandError::Input(format!("--transient: expected seconds from 0 on, got {value}")));
    }
    if args.csv_map.is_some() && !args.logs.iter().any(|log| is_csv(log)) {
        return Err(CommandError::Input("--csv-map: expected a .csv among the logs, got none".into()));
    }
    Ok(IdentifySettings {
        cutoff_hz: args.cutoff,
        fir: args.fir,
        sigma: args.sigma,
        ..IdentifySettings::default()
    })
}

/// Loads and conditions every flight, side by side; the same file twice is refused.
fn conditioned(
    args: &IdentifyArgs,
    vehicle: &Vehicle,
) -> Result<(Vec<Signals>, Vec<InputFile>), CommandError> {
    let read_as = ReadAs { csv_map: args.csv_map.as_ref(), system: args.system };
    let settings = ConditionSettings {
        transient_s: args.transient,
        thrust: if args.commands { ThrustPreference::Commands } else { ThrustPreference::Measured },
        ..ConditionSettings::default()
    };
    let one = |path: &std::path::PathBuf| {
        let flight = load(path, &read_as)?;
        let signals = condition(&flight.recording, vehicle, &settings)
            .map_err(|error| CommandError::Input(format!("{}: {error}", path.display())))?;
        Ok((signals, flight.input))
    };
    let done: Vec<Result<(Signals, InputFile), CommandError>> = args.logs.par_iter().map(one).collect();
    let (flights, inputs): (Vec<Signals>, Vec<InputFile>) =
        done.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    refuse_twins(&inputs.iter().collect::<Vec<_>>())?;
    Ok((flights, inputs))
}
