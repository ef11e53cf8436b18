//! `mavid validate LOG... --model A --model B...`: the paper's two validations and open-loop playback.

use std::path::{Path, PathBuf};

use mavid::compare::{
    PlaybackSettings, TenSignals, autopilot_flight, playback, recorded_tracking_m, resimulated,
};
use mavid::config::read_vehicle;
use mavid::estimate::theta_of;
use mavid::physics::Model;
use mavid::regression::{ZeroPhase, output_prediction_rms, paper_models};
use mavid::report::{
    ErrorTable, InputFile, Panel, ValidatedFlight, closed_loop_charts, closed_loop_table, playback_table,
    prediction_table, shortened_names, significant, svg, validation_report,
};
use mavid::signals::{Butterworth, ConditionSettings, Quality, Signals, ThrustSource};
use mavid::simulate::pid::{PidFlightSettings, PidSettings};
use mavid::text;
use mavid::vehicle::Vehicle;
use rayon::prelude::*;
use serde::Serialize;

use super::effects::{effects, with_stated_lag};
use super::explain::REPORT;
use super::flights::{Flight, IDENTIFIED, file, load, ready, refuse_twins, say};
use super::{CommandError, Outcome, output};
use crate::cli::ValidateArgs;

/// Lengths of the playback's windows, s.
const WINDOWS_S: [f64; 3] = [0.1, 0.5, 1.0];
/// Cut-off of the low-pass under the regression models, Hz.
const CUTOFF_HZ: f64 = 5.0;

/// A model by its file's name.
struct Named {
    name: String,
    input: InputFile,
    vehicle: Vehicle,
    model: Model,
}

/// All tables.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    models: Vec<String>,
    flights: Vec<FlightTables>,
}

/// One flight's tables.
#[derive(Debug, Serialize)]
struct FlightTables {
    input: InputFile,
    /// interval of the closed-loop and prediction errors, s
    span_s: (f64, f64),
    tables: Vec<ErrorTable>,
    #[serde(skip)]
    charts: Vec<Panel>,
    /// by the first model's thrust law
    #[serde(skip)]
    quality: Quality,
}

/// Runs the verb.
pub fn run(json: bool, args: &ValidateArgs) -> Result<Outcome, CommandError> {
    if !args.transient.is_finite() || args.transient < 0.0 {
        let got = args.transient;
        return Err(CommandError::Input(format!("--transient: expected seconds from 0 on, got {got}")));
    }
    // a target that cannot be written is told before the work
    if let Some(folder) = &args.out {
        output::folder(folder)?;
    }
    let mut models: Vec<Named> = args.models.iter().map(|path| named(path)).collect::<Result<_, _>>()?;
    told_apart(&mut models, &args.models);
    let logs: Vec<Vec<Flight>> =
        args.logs.par_iter().map(|path| load(path, &args.read, &IDENTIFIED)).collect::<Result<_, _>>()?;
    refuse_twins(&logs.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
    let one = |log| ready(log, |flight| flight_tables(flight, &models, args.transient));
    let done: Vec<Vec<(Flight, FlightTables)>> = logs.into_par_iter().map(one).collect::<Result<_, _>>()?;
    let told = |(flight, tables): (Flight, FlightTables)| FlightTables { input: flight.input, ..tables };
    let flights: Vec<FlightTables> = done.into_iter().flatten().map(told).collect();
    if let Some(folder) = &args.out {
        write_charts(folder, &flights)?;
        write_report(folder, &models, &flights, args.transient)?;
    }
    let document =
        Document { schema: 1, models: models.iter().map(|model| model.name.clone()).collect(), flights };
    if json {
        output::json(&document)?;
    } else {
        let heads = shortened_names(&document.models).into_iter();
        let heads = heads.map(|(head, name)| format!("{head} is {name}\n")).collect::<String>();
        let pages = document.flights.iter().map(|flight| {
            let tables: Vec<String> = flight.tables.iter().map(ErrorTable::page).collect();
            format!("{}\n\n{}", flight.input.path, tables.join("\n"))
        });
        let space = if heads.is_empty() { "" } else { "\n" };
        output::text(format!("{heads}{space}{}", pages.collect::<Vec<_>>().join("\n")).trim_end())?;
    }
    Ok(say(document.flights.iter().map(|flight| &flight.input)))
}

/// Models whose files have one name are called by their paths.
fn told_apart(models: &mut [Named], paths: &[PathBuf]) {
    let names: Vec<String> = models.iter().map(|model| model.name.clone()).collect();
    for ((model, path), name) in models.iter_mut().zip(paths).zip(&names) {
        if names.iter().filter(|other| *other == name).count() > 1 {
            model.name = text::path(&path);
        }
    }
}

fn named(path: &Path) -> Result<Named, CommandError> {
    let loaded = read_vehicle(path)?;
    output::warnings(path, &loaded.warnings);
    let refuse =
        |error: &dyn std::fmt::Display| CommandError::Input(format!("{}: {error}", text::path(&path)));
    let effects = effects(&loaded.model.effects, &text::path(&path), &loaded.vehicle)?;
    let effects = with_stated_lag(effects, &loaded.vehicle);
    let model = Model::new(&loaded.vehicle, effects).map_err(|error| refuse(&error))?;
    let name = path.file_stem().map_or_else(|| loaded.vehicle.name.clone(), |stem| text::path(&stem));
    Ok(Named { name, input: file(path)?, vehicle: loaded.vehicle, model })
}

fn flight_tables(flight: &Flight, models: &[Named], transient_s: f64) -> Result<FlightTables, CommandError> {
    let settings = ConditionSettings { transient_s: Some(transient_s), ..ConditionSettings::default() };
    // each model's own thrust law turns commands into thrusts
    let signals: Vec<Signals> = models
        .iter()
        .map(|model| flight.conditioned((&model.vehicle, Path::new(&model.input.path)), &settings))
        .collect::<Result<_, _>>()?;
    let Some(first) = signals.first() else {
        return Err(CommandError::Input("expected at least one --model".to_owned()));
    };
    let airborne = first.quality.airborne_s.first().copied().unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let end_s = first.grid.time_s(first.grid.count.saturating_sub(1)).min(airborne.1);
    let span_s = (first.grid.start_s.max(airborne.0) + transient_s, end_s);
    if span_s.1 <= span_s.0 {
        return Err(CommandError::Input(format!(
            "{}: expected flight beyond the first {transient_s} s (--transient), the vehicle is in the air until {:.1} s",
            flight.input.path, span_s.1
        )));
    }
    let (closed_loop, charts) = closed_loop(flight, first, models, span_s);
    let mut tables = vec![closed_loop];
    tables.extend(predictions(models, &signals, span_s));
    for window_s in WINDOWS_S {
        let settings = PlaybackSettings { window_s, ..PlaybackSettings::default() };
        let fits: Vec<_> = models
            .iter()
            .zip(&signals)
            .map(|(model, signals)| {
                let fit = playback((&model.model, &model.vehicle), signals, &settings);
                (model.name.clone(), fit.map_err(|error| error.to_string()))
            })
            .collect();
        tables.push(playback_table(window_s, &fits));
    }
    if tables.iter().all(|table| table.shown().is_empty()) {
        return Err(nothing_to_compare(&flight.input.path, &tables));
    }
    Ok(FlightTables { input: flight.input.clone(), span_s, tables, charts, quality: first.quality.clone() })
}

/// Each reason once.
fn nothing_to_compare(log: &str, tables: &[ErrorTable]) -> CommandError {
    let mut reasons: Vec<&str> = Vec::new();
    for why in tables.iter().flat_map(ErrorTable::remarks) {
        if !reasons.contains(&why) {
            reasons.push(why);
        }
    }
    CommandError::Input(format!("{log}: nothing to compare with: {}", reasons.join("; ")))
}

/// Table 4 and Figures 6 to 9; no figures where no model flew.
fn closed_loop(
    flight: &Flight,
    recorded: &Signals,
    models: &[Named],
    span_s: (f64, f64),
) -> (ErrorTable, Vec<Panel>) {
    let by_pid = recorded.quality.thrust_source == ThrustSource::Wrench;
    let nominal = &models[0].vehicle;
    let fly = |model: &Named| {
        let flown = if by_pid {
            let controller = PidSettings { mass_kg: nominal.body.mass_kg, ..PidSettings::default() };
            let settings = PidFlightSettings { controller, ..PidFlightSettings::default() };
            resimulated(&flight.recording, (&model.model, &model.vehicle), &settings)
        } else {
            autopilot_flight(&flight.recording, &model.model, nominal)
        };
        (model.name.clone(), flown.map_err(|error| error.to_string()))
    };
    let controller = if by_pid { "the paper's PID" } else { "an autopilot's cascade" };
    let title = format!(
        "Flown again in closed loop by {controller} from the recorded setpoints, {:.0} to {:.0} s",
        span_s.0, span_s.1
    );
    let flown: Vec<(String, Result<TenSignals, String>)> = models.par_iter().map(fly).collect();
    match TenSignals::of_signals(recorded) {
        Ok(recorded) => {
            let mut lines = vec![("recorded".to_owned(), &recorded)];
            lines.extend(flown.iter().filter_map(|(name, s)| s.as_ref().ok().map(|s| (name.clone(), s))));
            let table = closed_loop_table(title, &recorded, &flown, span_s);
            if table.shown().is_empty() {
                return (table, Vec::new());
            }
            let tracking = recorded_tracking_m(&flight.recording, &recorded, span_s);
            let notes = closed_loop_notes(by_pid, &models[0].name, tracking.ok().flatten());
            (ErrorTable { notes, ..table }, closed_loop_charts(&lines))
        }
        Err(error) => {
            let missing: Vec<_> =
                models.iter().map(|model| (model.name.clone(), Err(error.to_string()))).collect();
            (closed_loop_table(title, &TenSignals::default(), &missing, span_s), Vec::new())
        }
    }
}

/// Who flew the simulations, and what that leaves in the errors.
fn closed_loop_notes(by_pid: bool, nominal: &str, tracking_m: Option<[f64; 3]>) -> Vec<String> {
    let mut notes = vec![if by_pid {
        format!("controller: the paper's PID (28) to (32) with the mass of {nominal}, on exact states")
    } else {
        format!(
            "controller: position, velocity, attitude and rate loops with PX4's default gains, on exact states; it believes \
             {nominal}. The autopilot's own gains and estimates are not in the log: what it did otherwise is in every \
             column. force and torque tell models apart; position and attitude do so only as far as the controller does not hold them"
        )
    }];
    notes.extend(tracking_m.map(|[x, y, z]| {
        format!(
            "the recorded flight itself was off its setpoints by {x:.3}, {y:.3}, {z:.3} m RMS in x, y, z, which no model mends"
        )
    }));
    notes
}

/// (43) in both regression models.
fn predictions(models: &[Named], signals: &[Signals], span_s: (f64, f64)) -> [ErrorTable; 2] {
    let mut columns = [Vec::new(), Vec::new()];
    for (model, signals) in models.iter().zip(signals) {
        let theta = theta_of(&model.vehicle.body);
        let built = Butterworth::new(CUTOFF_HZ, 1.0 / signals.grid.step_s)
            .ok_or_else(|| {
                let rate_hz = 1.0 / signals.grid.step_s;
                format!("the recording's {rate_hz:.0} Hz are too few for a low-pass at {CUTOFF_HZ} Hz")
            })
            .and_then(|filter| {
                let filter = ZeroPhase::Butterworth(filter);
                paper_models(signals, model.vehicle.gravity_m_s2, &filter).ok_or_else(|| lacking(signals))
            });
        let rms = built.map(|(standard, filtered)| {
            [&standard, &filtered].map(|regression| output_prediction_rms(regression, &theta, span_s))
        });
        for (index, column) in columns.iter_mut().enumerate() {
            let found = rms.clone().and_then(|both| {
                both[index].ok_or_else(|| {
                    format!("no usable stretch between {:.1} and {:.1} s is long enough", span_s.0, span_s.1)
                })
            });
            column.push((model.name.clone(), found));
        }
    }
    let title = |which| {
        format!("Output prediction error (43) of the {which} regression model, by mass and inertia alone")
    };
    [prediction_table(title("standard"), &columns[0]), prediction_table(title("filtered"), &columns[1])]
}

/// What the regression models need of a recording and this one does not hold.
fn lacking(signals: &Signals) -> String {
    let what = if signals.rate.is_none() {
        "body rates"
    } else {
        "vertical motion (an accelerometer, or attitude with velocity or position)"
    };
    format!("the recording holds no {what}: the regression models need it")
}

/// The last line of a figure, by which one of an earlier run is known.
const FIGURE: &str = "<!-- a figure of mavid validate -->\n";

/// One file a flight. What an earlier run put there and this one did not is removed, so that nothing old passes for
/// new; files of others stay.
fn write_charts(folder: &Path, flights: &[FlightTables]) -> Result<(), CommandError> {
    let mut written = Vec::new();
    for (index, flight) in flights.iter().enumerate() {
        let stem = text::path(Path::new(&flight.input.path).file_stem().unwrap_or_default());
        // flights of different folders may have one name
        let path = folder.join(format!("{}-{stem}.svg", index + 1));
        if flight.charts.is_empty() {
            output::outdated(&path)?;
        } else {
            output::file(&path, &format!("{}{FIGURE}", svg(&flight.charts)))?;
            written.push(path);
        }
    }
    let unread =
        |error| CommandError::Input(format!("--out: cannot look into {}: {error}", text::path(&folder)));
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if !written.contains(&path) && is_figure(&path) {
            output::outdated(&path)?;
        }
    }
    Ok(())
}

/// Named and ended as a figure of this verb.
fn is_figure(path: &Path) -> bool {
    let name = text::path(path.file_name().unwrap_or_default());
    let numbered = name.split_once('-').is_some_and(|(number, _)| number.parse::<usize>().is_ok());
    let ended = || std::fs::read(path).is_ok_and(|bytes| bytes.ends_with(FIGURE.as_bytes()));
    numbered && name.ends_with(".svg") && ended()
}

fn write_report(
    folder: &Path,
    models: &[Named],
    flights: &[FlightTables],
    transient_s: f64,
) -> Result<(), CommandError> {
    let models: Vec<(String, InputFile)> =
        models.iter().map(|model| (model.name.clone(), model.input.clone())).collect();
    let flights: Vec<ValidatedFlight> = flights
        .iter()
        .map(|flight| ValidatedFlight {
            input: &flight.input,
            tables: &flight.tables,
            charts: &flight.charts,
            quality: &flight.quality,
        })
        .collect();
    let settings = [
        ("left out at the beginning, s".to_owned(), significant(transient_s, 3)),
        ("low-pass under the regression models, Hz".to_owned(), significant(CUTOFF_HZ, 3)),
    ];
    output::file(&folder.join(REPORT), &validation_report(&models, &flights, &settings))
}
