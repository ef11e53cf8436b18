//! `mavid identify LOG... --vehicle V`: parameters from recorded flights.

use mavid::config::{LoadedVehicle, read_vehicle};
use mavid::estimate::{Identification, IdentifySettings, ThrustScale, apply_anchor, identify};
use mavid::report::{
    IdentificationDocument, InputFile, history_charts, identification_page, model_toml, svg,
};
use mavid::signals::{ConditionSettings, Quality, Signals, ThrustPreference, condition};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

use super::flights::{ReadAs, is_csv, load, refuse_twins};
use super::{CommandError, Outcome, output};
use crate::cli::IdentifyArgs;

/// An identification with all that is told of it.
#[derive(Debug)]
pub struct Identified {
    vehicle: Vehicle,
    flights: Vec<Signals>,
    inputs: Vec<InputFile>,
    identification: Identification,
    scale: Option<ThrustScale>,
}

impl Identified {
    /// Loads, conditions and identifies.
    pub fn from(args: &IdentifyArgs) -> Result<Self, CommandError> {
        let LoadedVehicle { vehicle, warnings, .. } = read_vehicle(&args.vehicle)?;
        for warning in &warnings {
            output::message(&format!("warning: {}: {warning}", args.vehicle.display()));
        }
        let settings = settings(args)?;
        let (flights, inputs) = conditioned(args, &vehicle)?;
        let mut identification = identify(&flights, &vehicle, &settings)
            .map_err(|error| CommandError::Input(error.to_string()))?;
        let scale = apply_anchor(&mut identification, &vehicle);
        Ok(Self { vehicle, flights, inputs, identification, scale })
    }

    fn quality(&self) -> Vec<&Quality> {
        self.flights.iter().map(|signals| &signals.quality).collect()
    }

    /// As JSON.
    pub fn document(&self) -> IdentificationDocument {
        let quality = self.quality();
        IdentificationDocument::new(
            &self.identification,
            &self.vehicle,
            &quality,
            &self.inputs,
            self.scale.as_ref(),
        )
    }

    /// For people.
    pub fn page(&self) -> String {
        let page =
            identification_page(&self.identification, &self.vehicle, &self.quality(), self.scale.as_ref());
        page.trim_end().to_owned()
    }

    /// Writes model and chart where the arguments say so.
    pub fn write(&self, args: &IdentifyArgs) -> Result<(), CommandError> {
        if let Some(path) = &args.out {
            let text = model_toml(&self.identification, &self.vehicle, &self.inputs, self.scale.as_ref())?;
            output::file(path, &text)?;
        }
        if let Some(path) = &args.chart {
            output::file(path, &svg(&history_charts(&self.identification)))?;
        }
        Ok(())
    }

    /// Says what the recordings lost.
    pub fn outcome(&self) -> Outcome {
        let mut outcome = Outcome::Done;
        for input in self.inputs.iter().filter(|input| !input.losses.is_empty()) {
            output::message(&format!("{}: {}", input.path, input.losses.join("; ")));
            outcome = Outcome::DoneWithLoss;
        }
        outcome
    }
}

/// Runs the verb.
pub fn run(json: bool, args: &IdentifyArgs) -> Result<Outcome, CommandError> {
    let identified = Identified::from(args)?;
    if json {
        output::json(&identified.document())?;
    } else {
        output::text(&identified.page())?;
    }
    identified.write(args)?;
    Ok(identified.outcome())
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
