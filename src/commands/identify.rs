//! `mavid identify LOG... --vehicle V`: parameters from recorded flights.

use std::path::{Path, PathBuf};

use mavid::config::{LoadedVehicle, read_vehicle};
use mavid::diagnose::ExplainSettings;
use mavid::diagnose::joint::{RequestedEffects, identify_jointly};
use mavid::estimate::{Identification, IdentifySettings, PAPER_SIGMA, ThrustScale, apply_anchor, identify};
use mavid::report::{
    IdentificationDocument, IdentificationStory, InputFile, WithEffects, history_charts, identification_page,
    model_toml, svg,
};
use mavid::signals::{ConditionSettings, Quality, Signals, ThrustPreference};
use mavid::text;
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

use super::effects::effects;
use super::flights::{Flight, IDENTIFIED, is_csv, load, ready, refuse_twins, say};
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
    with: Option<WithEffects>,
}

impl Identified {
    /// Loads, conditions and identifies; what is odd about the vehicle's file is told before the work.
    pub fn from(args: &IdentifyArgs, tell: impl FnOnce(&[String])) -> Result<Self, CommandError> {
        let inputs: Vec<&PathBuf> = args.logs.iter().chain([&args.vehicle]).collect();
        let report = report(args);
        let outputs: Vec<&PathBuf> = args.out.iter().chain(&args.chart).chain(&report).collect();
        output::refuse_overwriting(&inputs, &outputs)?;
        let wanted = wanted(args)?;
        let loaded = read_vehicle(&args.vehicle)?;
        let LoadedVehicle { vehicle, warnings, .. } = &loaded;
        tell(warnings);
        let settings = settings(args)?;
        let recorded = recorded(args)?;
        let with = wanted.map(|wanted| with_effects(args, (&recorded, &loaded), &wanted)).transpose()?;
        let (inputs, flights) = conditioned(recorded, (vehicle, &args.vehicle), &usual(args))?;
        let mut identification =
            identify(&flights, vehicle, &settings).map_err(|error| CommandError::Input(error.to_string()))?;
        let scale = apply_anchor(&mut identification, vehicle);
        Ok(Self { vehicle: loaded.vehicle, flights, inputs, identification, scale, with })
    }

    fn quality(&self) -> Vec<&Quality> {
        self.flights.iter().map(|signals| &signals.quality).collect()
    }

    /// As JSON.
    pub fn document(&self) -> IdentificationDocument {
        let quality = self.quality();
        let document = IdentificationDocument::new(
            &self.identification,
            &self.vehicle,
            &quality,
            &self.inputs,
            self.scale.as_ref(),
        );
        match &self.with {
            Some(with) => document.with(with),
            None => document,
        }
    }

    /// For people.
    pub fn page(&self) -> String {
        let page = match &self.with {
            Some(with) => with.page(),
            None => {
                identification_page(&self.identification, &self.vehicle, &self.quality(), self.scale.as_ref())
            }
        };
        page.trim_end().to_owned()
    }

    fn report_html(&self) -> String {
        let story = IdentificationStory {
            identification: &self.identification,
            vehicle: &self.vehicle,
            flights: &self.flights,
            inputs: &self.inputs,
            scale: self.scale.as_ref(),
            with: self.with.as_ref(),
        };
        story.report_html()
    }

    /// Writes model, report and chart where the arguments say so.
    pub fn write(&self, args: &IdentifyArgs) -> Result<(), CommandError> {
        if let Some(path) = &args.out {
            let text = match &self.with {
                Some(with) => with.model_toml(&self.inputs)?,
                None => model_toml(&self.identification, &self.vehicle, &self.inputs, self.scale.as_ref())?,
            };
            output::file(path, &text)?;
        }
        if let Some(path) = report(args) {
            output::file(&path, &self.report_html())?;
        }
        if let Some(path) = &args.chart {
            output::file(path, &svg(&history_charts(&self.identification)))?;
        }
        Ok(())
    }

    /// Says what the recordings lost.
    pub fn outcome(&self) -> Outcome {
        say(self.inputs.iter())
    }
}

/// Runs the verb.
pub fn run(json: bool, args: &IdentifyArgs) -> Result<Outcome, CommandError> {
    let identified = Identified::from(args, |warnings| output::warnings(&args.vehicle, warnings))?;
    if json {
        output::json(&identified.document())?;
    } else {
        output::text(&identified.page())?;
    }
    identified.write(args)?;
    Ok(identified.outcome())
}

/// Where the report goes: as asked for, or beside the model.
fn report(args: &IdentifyArgs) -> Option<PathBuf> {
    args.report.clone().or_else(|| args.out.as_ref().map(|model| model.with_extension("html")))
}

fn settings(args: &IdentifyArgs) -> Result<IdentifySettings, CommandError> {
    for (name, value) in [("--sigma", Some(args.sigma)), ("--cutoff", args.cutoff)] {
        if let Some(value) = value.filter(|value| !value.is_finite() || *value <= 0.0) {
            return Err(CommandError::Input(format!("{name}: expected a positive number, got {value}")));
        }
    }
    let filtered = args.cutoff.is_some() || args.fir || args.sigma != PAPER_SIGMA;
    if filtered && !args.with.is_empty() {
        return Err(CommandError::Input(
            "--cutoff, --fir and --sigma are for the methods LS, GD, FMLS and FMGD; expected them without --with, which fits the \
             weak form, where nothing is differentiated and nothing is low-passed"
                .into(),
        ));
    }
    if let Some(value) = args.transient.filter(|value| !value.is_finite() || *value < 0.0) {
        return Err(CommandError::Input(format!("--transient: expected seconds from 0 on, got {value}")));
    }
    if args.read.csv_map.is_some() && !args.logs.iter().any(|log| is_csv(log)) {
        return Err(CommandError::Input("--csv-map: expected a .csv among the logs, got none".into()));
    }
    Ok(IdentifySettings {
        cutoff_hz: args.cutoff,
        fir: args.fir,
        sigma: args.sigma,
        ..IdentifySettings::default()
    })
}

/// The effects that were asked for; `None` without any.
fn wanted(args: &IdentifyArgs) -> Result<Option<RequestedEffects>, CommandError> {
    if args.with.is_empty() {
        return Ok(None);
    }
    RequestedEffects::of(&args.with)
        .map(Some)
        .map_err(|error| CommandError::Input(format!("--with: {error}")))
}

/// Loads the flights of every log, side by side; the same file twice is refused.
fn recorded(args: &IdentifyArgs) -> Result<Vec<Vec<Flight>>, CommandError> {
    let done: Vec<Result<Vec<Flight>, CommandError>> =
        args.logs.par_iter().map(|path| load(path, &args.read, &IDENTIFIED)).collect();
    let logs = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    refuse_twins(&logs.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
    Ok(logs)
}

fn usual(args: &IdentifyArgs) -> ConditionSettings {
    ConditionSettings {
        transient_s: args.transient,
        thrust: if args.commands { ThrustPreference::Commands } else { ThrustPreference::Measured },
        ..ConditionSettings::default()
    }
}

/// Conditions the flights of every log, side by side, and lets go of the recordings.
fn conditioned(
    logs: Vec<Vec<Flight>>,
    vehicle: (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<(Vec<InputFile>, Vec<Signals>), CommandError> {
    let one = |log| {
        let flights = ready(log, |flight: &Flight| flight.conditioned(vehicle, settings))?;
        Ok(flights.into_iter().map(|(flight, signals)| (flight.input, signals)).collect())
    };
    let done: Vec<Result<Vec<(InputFile, Signals)>, CommandError>> = logs.into_par_iter().map(one).collect();
    let flights = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(flights.into_iter().flatten().unzip())
}

/// Left out at the beginning of a flight, s, as `explain` does.
const TRANSIENT_S: f64 = 1.0;

/// The named effects together with the rigid body, on the rows on which `explain` would find them.
fn with_effects(
    args: &IdentifyArgs,
    (recorded, loaded): (&[Vec<Flight>], &LoadedVehicle),
    wanted: &RequestedEffects,
) -> Result<WithEffects, CommandError> {
    let vehicle = &loaded.vehicle;
    let known = effects(&loaded.model.effects, &text::path(&args.vehicle), vehicle)?;
    wanted.check_wind(&known).map_err(|error| CommandError::Input(format!("--with: {error}")))?;
    let by_commands = args.commands || wanted.need_commands();
    let settings = ConditionSettings {
        transient_s: Some(args.transient.unwrap_or(TRANSIENT_S)),
        thrust: if by_commands { ThrustPreference::Commands } else { ThrustPreference::Measured },
        askew: wanted.turns_inertial_unit(),
        ..ConditionSettings::default()
    };
    let mut flights = Vec::new();
    for log in recorded {
        let made = log.iter().map(|flight| flight.conditioned((vehicle, &args.vehicle), &settings));
        let (usable, refused): (Vec<_>, Vec<_>) = made.partition(Result::is_ok);
        if let (true, Some(Err(why))) = (usable.is_empty(), refused.into_iter().next()) {
            return Err(why);
        }
        flights.extend(usable.into_iter().flatten());
    }
    let half_width_s = ExplainSettings::default().half_width_s;
    let together = identify_jointly(&flights, (vehicle, &known), wanted, half_width_s).map_err(|error| {
        let logs: Vec<String> = args.logs.iter().map(|log| text::path(&log)).collect();
        CommandError::Input(format!("{}: {error}", logs.join(", ")))
    })?;
    let quality = flights.into_iter().map(|signals| signals.quality).collect();
    Ok(WithEffects { together, vehicle: vehicle.clone(), quality })
}
