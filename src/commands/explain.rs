//! `mavid explain LOG... --vehicle V`: which physics the model left out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mavid::config::{StoredTrajectory, read_vehicle, trajectory_to_toml};
use mavid::diagnose::experiment::{NextFlight, NextSettings, design};
use mavid::diagnose::holdout::{HeldOut, HoldoutSettings, Split, differing, split_last_periods};
use mavid::diagnose::{Empirical, ExplainSettings, Named, Trace, Verdict, explain};
use mavid::recording::Recording;
use mavid::report::{ExplanationDocument, Given, InputFile, ShownOn, Story, explanation_page};
use mavid::signals::{ConditionSettings, Signals, ThrustPreference};
use mavid::text;
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

use super::effects::effects;
use super::flights::{EXPLAINED, Flight, is_csv, load, ready, refuse_twins, shared};
use super::{CommandError, Outcome, output};
use mavid::diagnose::signatures::signature_of;

use crate::cli::ExplainArgs;

/// How a note begins that is more than a remark.
const DOUBT: &str = "warning: ";
/// Share of the flight that may be saturated without a word.
const SATURATED: f64 = 0.3;
/// A file is wrong by less than this in mass.
const MASS_FACTOR: f64 = 1.6;
/// What a recording without velocity cannot tell.
const NO_VELOCITY: &str = "no velocity (LOCAL_POSITION_NED or similar), or no attitude, is recorded: drag, wind and other effects of the air \
                           cannot be tried, and what is named may stand for what they do to the rotation";

/// Names of what [`Explained::write`] writes.
const MODEL: &str = "model.toml";
pub const REPORT: &str = "report.html";
const DOCUMENT: &str = "explanation.json";
/// All of them.
pub const WRITTEN: [&str; 3] = [MODEL, REPORT, DOCUMENT];

/// An explanation with all that is told of it.
#[derive(Debug)]
pub struct Explained {
    story: Story,
    traces: Vec<Trace>,
}

impl Explained {
    /// Loads, conditions, explains and shows; writes the next flight where one is asked for.
    pub fn from(args: &ExplainArgs) -> Result<Self, CommandError> {
        check(args)?;
        let loaded = read_vehicle(&args.vehicle)?;
        let vehicle = loaded.vehicle;
        let of_file = loaded.warnings.iter();
        let mut warnings: Vec<String> =
            of_file.map(|warning| format!("{}: {warning}", text::path(&args.vehicle))).collect();
        let known = effects(&loaded.model.effects, &text::path(&args.vehicle), &vehicle)?;
        if !known.is_empty() {
            let names: Vec<&str> = known.iter().map(|active| active.effect().id()).collect();
            warnings.push(format!(
                "{}: its effects ({}) are left out and looked for anew",
                text::path(&args.vehicle),
                names.join(", ")
            ));
        }
        let of_holdout = |error| match error {
            CommandError::Input(why) => {
                CommandError::Input(format!("--holdout: expected a flight of {}: {why}", vehicle.name))
            }
            other => other,
        };
        let (logs, held_logs) =
            (recorded(&args.logs, args)?, recorded(&args.holdout, args).map_err(of_holdout)?);
        refuse_twins(&logs.iter().chain(&held_logs).map(Vec::as_slice).collect::<Vec<_>>())?;
        let mut flights = flown(logs, args, &vehicle)?;
        let held = flown(held_logs, args, &vehicle).map_err(of_holdout)?;
        refuse_shared(&flights, &held)?;
        let whole = flights.last().map(|flight| flight.signals.clone());
        let (shown_on, back) = if held.is_empty() {
            hold_back(&mut flights)
        } else {
            (ShownOn::Flights(held.iter().map(|flight| flight.input.clone()).collect()), None)
        };
        warnings.extend(flights.iter().chain(&held).filter_map(|flight| losses(&flight.input)));
        for flight in flights.iter().chain(&held) {
            let doubts = flight.signals.quality.notes.iter().filter_map(|note| note.strip_prefix(DOUBT));
            warnings.extend(doubts.map(|doubt| format!("{}: {doubt}", flight.input.path)));
            let used = &flight.signals.quality.usable;
            if !used.saturation_kept && used.saturated_s > SATURATED * (used.usable_s + used.saturated_s) {
                warnings.push(format!(
                    "{}: rotors were at a bound of their commands for {:.0} s, which are left out, and {:.0} s are used: what was left out may \
                     show in other places than its own; fly a gentler trajectory (mavid plan --limits)",
                    flight.input.path, used.saturated_s, used.usable_s
                ));
            }
        }
        for flight in flights
            .iter()
            .filter(|flight| flight.signals.velocity.is_none() || flight.signals.attitude.is_none())
        {
            warnings.push(format!("{}: {NO_VELOCITY}", flight.input.path));
        }
        let mut story = told(args, (&vehicle, &warnings), &flights, (&held, back.as_ref(), shown_on))?;
        // what changed in the part held back, or shortly before it, is nowhere in the part explained
        if let (Some(whole), Some(last), true) = (whole, flights.last_mut(), changes_late(&story))
            && held.is_empty()
        {
            let part = std::mem::replace(&mut last.signals, whole);
            let reason = "something changes in what would be held back, so the whole flight is explained; give another with --holdout";
            let shown_on = ShownOn::Nothing { reason: reason.to_owned() };
            let all = told(args, (&vehicle, &warnings), &flights, (&[], None, shown_on))?;
            let changes = |story: &Story| {
                story.effects.iter().any(|named| {
                    signature_of(named.id).is_some_and(|signature| signature.role.moment.is_some())
                })
            };
            if changes(&all) && !changes(&story) {
                story = all;
            } else if let Some(last) = flights.last_mut() {
                last.signals = part;
            }
        }
        let signals: Vec<Signals> = flights.iter().map(|flight| flight.signals.clone()).collect();
        let traces: Vec<Trace> = signals
            .iter()
            .filter_map(|signals| Trace::new(signals, &vehicle, story.given.settings.half_width_s).ok())
            .collect();
        if let Some(path) = &args.next {
            story.next = Some(next_flight(&story, &signals, path)?);
        }
        Ok(Self { story, traces })
    }

    /// The effects that are named.
    pub fn named(&self) -> &[Named] {
        &self.story.effects
    }

    /// The answer in one sentence.
    pub fn answer(&self) -> String {
        self.story.answer()
    }

    /// As JSON.
    pub fn document(&self) -> ExplanationDocument {
        ExplanationDocument::new(&self.story)
    }

    /// For people.
    pub fn page(&self) -> String {
        explanation_page(&self.story).trim_end().to_owned()
    }

    /// Writes model, report and document into a folder, which is made.
    pub fn write(&self, folder: &Path) -> Result<(), CommandError> {
        output::folder(folder)?;
        output::file(&folder.join(MODEL), &self.story.model_toml()?)?;
        output::file(&folder.join(REPORT), &self.story.report_html(&self.traces))?;
        output::file(&folder.join(DOCUMENT), &output::json_text(&self.document())?)
    }

    /// Says what is to be known about the data.
    pub fn outcome(&self) -> Outcome {
        for warning in &self.story.given.warnings {
            output::message(&format!("warning: {warning}"));
        }
        let held: &[InputFile] =
            if let ShownOn::Flights(inputs) = &self.story.shown_on { inputs } else { &[] };
        let inputs = || self.story.given.inputs.iter().chain(held);
        for input in inputs() {
            input.notes.iter().for_each(|note| output::message(&format!("{}: {note}", input.path)));
        }
        let lossless = inputs().all(|input| input.losses.is_empty());
        if lossless { Outcome::Done } else { Outcome::DoneWithLoss }
    }
}

/// Runs the verb.
pub fn run(json: bool, args: &ExplainArgs) -> Result<Outcome, CommandError> {
    let explained = Explained::from(args)?;
    if let Some(folder) = &args.out {
        explained.write(folder)?;
    }
    if json {
        output::json(&explained.document())?;
    } else {
        output::text(&explained.page())?;
    }
    Ok(explained.outcome())
}

fn check(args: &ExplainArgs) -> Result<(), CommandError> {
    let transient_s = args.transient;
    if !transient_s.is_finite() || transient_s < 0.0 {
        return Err(CommandError::Input(format!(
            "--transient: expected seconds from 0 on, got {transient_s}"
        )));
    }
    if args.read.csv_map.is_some() && !args.logs.iter().chain(&args.holdout).any(|log| is_csv(log)) {
        return Err(CommandError::Input("--csv-map: expected a .csv among the logs, got none".into()));
    }
    if let Some(path) = args.out.as_ref().filter(|path| path.exists() && !path.is_dir()) {
        return Err(CommandError::Input(format!(
            "--out: expected a folder, {} is a file",
            text::path(&path)
        )));
    }
    let inputs: Vec<&PathBuf> = args.logs.iter().chain(&args.holdout).chain([&args.vehicle]).collect();
    let written: Vec<PathBuf> =
        args.out.iter().flat_map(|folder| WRITTEN.map(|name| folder.join(name))).collect();
    output::refuse_overwriting(&inputs, &args.next.iter().chain(&written).collect::<Vec<_>>())?;
    // a target that cannot be written is told before the work
    if let Some(folder) = &args.out {
        output::folder(folder)?;
    }
    if let Some(parent) = args.next.as_deref().and_then(Path::parent)
        && !parent.as_os_str().is_empty()
        && !parent.is_dir()
    {
        return Err(CommandError::Input(format!(
            "--next: expected a file in a folder that exists, {} does not",
            text::path(&parent)
        )));
    }
    Ok(())
}

/// A flight made ready.
struct Flown {
    recording: Recording,
    signals: Signals,
    input: InputFile,
}

impl Flown {
    fn held_out(&self) -> HeldOut<'_> {
        HeldOut { name: &self.input.path, signals: &self.signals, recording: Some(&self.recording) }
    }
}

/// The part held back is another's, or what is left of the part explained drifts with time.
fn changes_late(story: &Story) -> bool {
    let drifts =
        story.located.state.iter().any(|state| ["time", "voltage"].contains(&state.variable.as_str()));
    story.other_vehicle().is_some() || (story.verdict() == Verdict::Unexplained && drifts)
}

/// Explains the flights and shows the better model; what is to be said of the data before comes first.
fn told(
    args: &ExplainArgs,
    (vehicle, warnings): (&Vehicle, &[String]),
    flights: &[Flown],
    (held, back, shown_on): (&[Flown], Option<&Signals>, ShownOn),
) -> Result<Story, CommandError> {
    let settings = ExplainSettings::default();
    let signals: Vec<Signals> = flights.iter().map(|flight| flight.signals.clone()).collect();
    let explanation = explain(&signals, vehicle, &settings).map_err(|error| {
        let logs: Vec<String> = args.logs.iter().map(|log| text::path(&log)).collect();
        CommandError::Input(format!("{}: {error}", logs.join(", ")))
    })?;
    let mut warnings = warnings.to_vec();
    let factor = explanation.search.after.base.vehicle.body.mass_kg / vehicle.body.mass_kg;
    if !(1.0 / MASS_FACTOR..=MASS_FACTOR).contains(&factor) {
        warnings.push(format!(
            "the mass that flies is {factor:.2} times what the vehicle file states: another vehicle's file, or a thrust coefficient \
             that is off by as much?"
        ));
    }
    let given = Given {
        vehicle: vehicle.clone(),
        inputs: flights.iter().map(|flight| flight.input.clone()).collect(),
        quality: flights.iter().map(|flight| flight.signals.quality.clone()).collect(),
        settings,
        transient_s: args.transient,
        warnings,
    };
    let mut story = Story::new(given, explanation);
    show(&mut story, flights, (held, back), shown_on);
    Ok(story)
}

/// Loads the flights of every log, side by side.
fn recorded(logs: &[PathBuf], args: &ExplainArgs) -> Result<Vec<Vec<Flight>>, CommandError> {
    let done: Vec<Result<Vec<Flight>, CommandError>> =
        logs.par_iter().map(|path| load(path, &args.read, &EXPLAINED)).collect();
    done.into_iter().collect()
}

/// Conditions the flights of every log, side by side.
fn flown(logs: Vec<Vec<Flight>>, args: &ExplainArgs, vehicle: &Vehicle) -> Result<Vec<Flown>, CommandError> {
    let settings = ConditionSettings {
        transient_s: Some(args.transient),
        thrust: ThrustPreference::BestSampled,
        ..ConditionSettings::default()
    };
    let one = |log| ready(log, |flight: &Flight| flight.conditioned((vehicle, &args.vehicle), &settings));
    let done: Vec<Result<Vec<(Flight, Signals)>, CommandError>> = logs.into_par_iter().map(one).collect();
    let flights = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    let made = |(Flight { recording, input, .. }, signals)| Flown { recording, signals, input };
    Ok(flights.into_iter().flatten().map(made).collect())
}

/// A flight that was used, or a part of it, shows nothing as a hold-out.
fn refuse_shared(flights: &[Flown], held: &[Flown]) -> Result<(), CommandError> {
    for hold_out in held {
        for flight in flights {
            if let Some(share) = shared(&hold_out.recording, &flight.recording) {
                return Err(CommandError::Input(format!(
                    "--holdout: expected a flight that is not explained, {:.0} % of {} are in {} as well",
                    100.0 * share,
                    hold_out.input.path,
                    flight.input.path
                )));
            }
        }
    }
    Ok(())
}

/// The end of the last flight, which is then not explained.
fn hold_back(flights: &mut [Flown]) -> (ShownOn, Option<Signals>) {
    let split = flights.last().and_then(|last| split_last_periods(&last.signals));
    let (Some(Split { identify, holdout, from_s, .. }), Some(last)) = (split, flights.last_mut()) else {
        let reason = "the flight is too short to hold a part of it back; give another with --holdout";
        return (ShownOn::Nothing { reason: reason.to_owned() }, None);
    };
    last.signals = identify;
    let seconds = holdout.usable.iter().filter(|used| **used).count() as f64 * holdout.grid.step_s;
    (ShownOn::HeldBack { from_s, seconds }, Some(holdout))
}

/// Prediction errors before and after, on what was explained and on what was not.
fn show(story: &mut Story, flights: &[Flown], (held, back): (&[Flown], Option<&Signals>), shown_on: ShownOn) {
    let all: Vec<Signals> = flights.iter().map(|flight| flight.signals.clone()).collect();
    let (vehicle, settings) = (&story.given.vehicle, &story.given.settings);
    let empirical = match Empirical::fit(&story.explanation, &all, vehicle, settings) {
        Ok(empirical) => empirical,
        Err(error) => {
            story.given.warnings.push(format!("no empirical term: {error}"));
            None
        }
    };
    let used: Vec<HeldOut> = flights.iter().map(Flown::held_out).collect();
    if let Err(error) = story.show_identification(&used, empirical.as_ref()) {
        story.given.warnings.push(format!("open-loop prediction: {error}"));
    }
    if let [_, _, ..] = used.as_slice() {
        let settings = HoldoutSettings::default();
        match differing(&story.explanation, &used, &story.given.vehicle, &settings) {
            Ok(why) => story.given.warnings.extend(why),
            Err(error) => {
                story.given.warnings.push(format!("whether the flights are of one vehicle: {error}"))
            }
        }
    }
    let mut shown: Vec<HeldOut> = held.iter().map(Flown::held_out).collect();
    shown.extend(back.map(|signals| HeldOut { name: "the part held back", signals, recording: None }));
    if shown.is_empty() {
        story.shown_on = shown_on;
    } else if let Err(error) = story.show_holdout(&shown, empirical.as_ref(), shown_on) {
        story.given.warnings.push(format!("hold-out: {error}"));
        story.shown_on = ShownOn::Nothing { reason: error.to_string() };
    }
    story.empirical = empirical;
}

/// Designs and writes the flight that tells apart what these cannot; `Err` inside: why there is none.
fn next_flight(
    story: &Story,
    signals: &[Signals],
    path: &Path,
) -> Result<Result<NextFlight, String>, CommandError> {
    let found = design(&story.explanation, signals, &story.given.vehicle, &NextSettings::default());
    let next = match found {
        Ok(next) => next,
        Err(why) => {
            output::message(&format!("--next: nothing written: {why}"));
            output::outdated(path)?;
            return Ok(Err(why.to_string()));
        }
    };
    let stored = StoredTrajectory {
        series: next.trajectory.clone(),
        repeats: next.repeats,
        limits: next.limits,
        criterion: next.pairs.first().map(|pair| ("t_optimality_sigma".to_owned(), pair.after)),
        margins: BTreeMap::new(),
        standard_errors: BTreeMap::new(),
        transitions: None,
    };
    output::file(path, &trajectory_to_toml(&stored)?)?;
    Ok(Ok(next))
}

fn losses(input: &InputFile) -> Option<String> {
    (!input.losses.is_empty()).then(|| format!("{}: {}", input.path, input.losses.join("; ")))
}
