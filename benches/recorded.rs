//! Vehicles that changed, by logs that real autopilots wrote: what `compare` and the report of a fleet answer.
//!
//! `cargo bench --bench recorded [-- --out FILE]` compares real flights with whole and with cut propellers, pairs of flights of
//! both autopilots' simulators, and pairs of real flights of three sessions. `-- --history [--shuffles N] [--out FILE]` reports real flights as the history of one vehicle.
//! `--out` stores the figures in sections of a file, of which the book is made. The logs are those of `MAVID_SHARED`
//! (`../shared`).
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use std::path::{Path, PathBuf};

use mavid::fleet::{FleetReport, LogRows, LogSettings, LogTask, ReportSettings, SHUFFLES, log_rows};
use mavid::recording::Quantity;
use mavid::study::{CompareRequest, CompareStudy, Depth, Silent, VehicleGiven, compare};
use rayon::prelude::*;
use support::comparison::{Answer, Cut, CutPropellers, Session, Sessions, SimulatedPair, Simulators};
use support::digits::short;
use support::fleet::{CutHistory, FoundStep};
use support::recorded::{alarms, answer, changes};
use support::sections::store;
use support::{Arguments, end};

/// Flights by the cut of the propeller of motor 1, mm, in the order of their dates; whole propellers first.
const CUTS: [(u32, [&str; 3]); 5] = [
    (0, ["09", "04", "02"]),
    (5, ["13", "01", "07"]),
    (10, ["11", "05", "14"]),
    (20, ["15", "12", "03"]),
    (25, ["06", "08", "10"]),
];
/// Flights of one history with the cut of each.
const HISTORY: [(u32, &str); 5] = [(0, "09"), (0, "04"), (0, "02"), (20, "15"), (25, "08")];
/// Pairs of one simulated vehicle each: name, vehicle file, earlier and later flight, ending of the on-board logs.
const PAIRS: [(&str, &str, [&str; 2], &str); 4] = [
    ("PX4, rotor 3 at 0.93", "px4-v2.toml", ["px04", "px05"], "ulg"),
    ("ArduCopter, rotor 3 at 0.93", "ardupilot-quad-a.toml", ["ap01", "ap02"], "bin"),
    ("ArduCopter, unchanged", "ardupilot-quad-a.toml", ["ap03", "ap04"], "bin"),
    ("another ArduCopter, unchanged", "ardupilot-quad-c.toml", ["ap07", "ap08"], "bin"),
];

/// Flights of small quadrotors. Those of a row agree in what the accelerometer reads at rest and in the markers' tilt; those of two
/// rows do not.
const SESSIONS: [&[&str]; 3] = [
    &["circle_medium_rep2", "figure8_slow_rep2", "helix_fast_rep1", "oval_fast_rep1"],
    &["circle_fast_rep2", "figure8_medium_rep2"],
    &["figure8_fast_rep2", "linear_ramp_rep2"],
];

fn main() {
    let arguments = Arguments::of_process();
    let root = std::env::var_os("MAVID_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"), PathBuf::from);
    let folder = root.join("onboard");
    if !folder.is_dir() {
        end(&format!("expected recorded flights in {}, found no such folder", folder.display()));
    }
    let (command, out) = (arguments.command("recorded"), arguments.text("--out"));
    if arguments.has("--history") {
        let run =
            cut_history(command, &folder.join("propeller_cut"), arguments.number("--shuffles", SHUFFLES));
        return out.iter().for_each(|file| store(file, "cut_propellers", &run));
    }
    let cuts: Vec<Cut> = CUTS.par_iter().map(|cut| cut_flights(&folder.join("propeller_cut"), cut)).collect();
    cuts.iter().for_each(|cut| println!("{cut:?}"));
    let pairs: Vec<SimulatedPair> =
        PAIRS.par_iter().map(|pair| simulated(&folder.join("sitl"), pair)).collect();
    pairs.iter().for_each(|pair| println!("{pair:?}"));
    let sessions = sessions(command.clone(), &root.join("recordings/nanobench"));
    println!("{sessions:?}");
    if let Some(file) = &out {
        store(file, "sessions", &sessions);
        store(file, "cut_propellers", &CutPropellers { command: command.clone(), cuts: cuts.clone() });
        store(file, "simulators", &Simulators { command: command.clone(), pairs: pairs.clone() });
    }
}

/// Compares the earlier with the later flights; ends the process where that cannot be done.
fn compared(before: Vec<PathBuf>, after: Vec<PathBuf>, vehicle: Option<VehicleGiven>) -> CompareStudy {
    let request = CompareRequest {
        before,
        after,
        vehicle,
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    compare(&request, &Silent).unwrap_or_else(|error| end(&error.to_string()))
}

fn answered(study: &CompareStudy, flights: (&[&str], &[&str])) -> Answer {
    answer(study, study.compared.as_ref().expect("two groups"), flights)
}

/// Neither mass nor size is given.
fn cut_flights(folder: &Path, (cut_mm, flights): &(u32, [&str; 3])) -> Cut {
    let whole = &CUTS[0].1;
    let of = |earlier: &[&str], later: &[&str]| {
        let paths = |names: &[&str]| names.iter().map(|name| cut_log(folder, name)).collect();
        answered(&compared(paths(earlier), paths(later), None), (earlier, later))
    };
    let single = flights.iter().map(|flight| {
        let earlier: Vec<&str> = whole.iter().copied().filter(|other| other != flight).collect();
        of(&earlier, &[*flight])
    });
    Cut {
        cut_mm: *cut_mm,
        single: single.collect(),
        together: (*cut_mm > 0).then(|| of(whole.as_slice(), flights.as_slice())),
    }
}

fn cut_log(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("flight_{name}.BIN"))
}

fn simulated(
    folder: &Path,
    (name, vehicle, [earlier, later], ending): &(&str, &str, [&str; 2], &str),
) -> SimulatedPair {
    let by = |ending: &str| {
        let path = |flight: &str| vec![folder.join(flight).with_extension(ending)];
        let vehicle = VehicleGiven::File(folder.join(vehicle));
        answered(&compared(path(earlier), path(later), Some(vehicle)), (&[*earlier], &[*later]))
    };
    SimulatedPair { name: (*name).to_owned(), by_telemetry: by("tlog"), on_board: by(ending) }
}

/// Every pair of the flights of [`SESSIONS`] by their balance alone: commands at 100 Hz, no body that is known.
fn sessions(command: String, folder: &Path) -> Sessions {
    let path = |flight: &str| folder.join(flight).with_extension("csv");
    let all: Vec<(usize, &str)> = SESSIONS
        .iter()
        .enumerate()
        .flat_map(|(session, flights)| flights.iter().map(move |flight| (session, *flight)))
        .collect();
    let pairs: Vec<_> =
        (0..all.len()).flat_map(|one| (one + 1..all.len()).map(move |other| (one, other))).collect();
    let study = |before: Vec<PathBuf>, after: Vec<PathBuf>| {
        let request = CompareRequest {
            before,
            after,
            vehicle: Some(VehicleGiven::File(folder.join("vehicle.toml"))),
            transient_s: CompareRequest::TRANSIENT_S,
            balance_only: true,
            ..CompareRequest::default()
        };
        compare(&request, &Silent).unwrap_or_else(|error| end(&error.to_string()))
    };
    let judged: Vec<(bool, bool)> = pairs
        .par_iter()
        .map(|&(one, other)| {
            let changed = study(vec![path(all[one].1)], vec![path(all[other].1)]).has_changed();
            (all[one].0 == all[other].0, changed)
        })
        .collect();
    let count = |is_within: bool| {
        let of = judged.iter().filter(|(within, _)| *within == is_within);
        (of.clone().count(), of.filter(|(_, changed)| *changed).count())
    };
    let session = |flights: &&[&str]| {
        let [first, others @ ..] = flights else { end("expected flights of a session, got none") };
        let balance = study(vec![path(first)], others.iter().map(|flight| path(flight)).collect()).balance;
        let mean = |axis: usize| {
            balance.flights.iter().map(|of| of.lean[axis]).sum::<f64>() / balance.flights.len() as f64
        };
        Session {
            flights: flights.iter().map(|flight| (*flight).to_owned()).collect(),
            at_rest_m_s2: flights.iter().map(|flight| short(at_rest_m_s2(&path(flight)))).collect(),
            balance: [0, 1, 2].map(|axis| short(mean(axis))),
        }
    };
    Sessions {
        command,
        sessions: SESSIONS.iter().map(session).collect(),
        within: count(true),
        between: count(false),
    }
}

/// Mean of the accelerometer along x until a motor turns, m/s^2.
fn at_rest_m_s2(table: &Path) -> f64 {
    let opened = mavid::log::open(table, &mavid::log::OpenOptions::default())
        .unwrap_or_else(|error| end(&error.to_string()));
    let stream = |quantity: Quantity| {
        let streams = &opened.recording.streams;
        let found = streams.iter().find(|(key, _)| key.quantity == quantity).map(|(_, stream)| stream);
        found.unwrap_or_else(|| end(&format!("{}: no {}", table.display(), quantity.name())))
    };
    let commands = stream(Quantity::ActuatorCommand);
    let turns = |index: &usize| commands.sample(*index).iter().any(|command| *command > 0.0);
    let from_s = (0..commands.len()).find(turns).map_or(f64::INFINITY, |index| commands.time_s[index]);
    let force = stream(Quantity::SpecificForce);
    let rest: Vec<f64> = (0..force.len())
        .filter(|index| force.time_s[*index] < from_s)
        .map(|index| force.sample(index)[0])
        .collect();
    rest.iter().sum::<f64>() / rest.len() as f64
}

/// The flights of [`HISTORY`] as a fleet of one vehicle.
fn cut_history(command: String, folder: &Path, shuffles: u32) -> CutHistory {
    let mut rows = LogRows::default();
    for (place, (_, name)) in HISTORY.iter().enumerate() {
        let path = cut_log(folder, name);
        let vehicles = "[[vehicle]]\nname = 'one'\nlogs = '*'\nmass = 1.5\n";
        let settings = LogSettings {
            depth: Depth::Balance,
            vehicles: toml::from_str(vehicles).expect("a list of one vehicle"),
            ..LogSettings::default()
        };
        let task = LogTask { sha256: place.to_string(), uri: place.to_string(), path, bytes: 0, settings };
        let mut flight = log_rows(&task);
        // in the order of the list, whatever their dates
        flight.flights.iter_mut().for_each(|row| row.start_utc_us = i64::try_from(place).ok());
        rows.extend(flight);
    }
    let report =
        FleetReport::of(&rows, &ReportSettings { false_alarms: mavid::fleet::FALSE_ALARMS, shuffles });
    let vehicle =
        report.vehicles.first().unwrap_or_else(|| end("expected a vehicle with a balance, got none"));
    let study = &vehicle.history.study;
    let steps = study.history.iter().map(|step| {
        let strongest = changes(study, &step.change).into_iter().next();
        FoundStep {
            flight: step.from + 1,
            motor: strongest.as_ref().and_then(|change| change.motor),
            after: strongest.as_ref().and_then(|change| change.after),
            std: strongest.as_ref().and_then(|change| change.std),
        }
    });
    let run = CutHistory {
        command,
        cuts_mm: HISTORY.iter().map(|(cut_mm, _)| *cut_mm).collect(),
        steps: steps.collect(),
        alarms: alarms(&report.alarms),
    };
    println!("{run:?}");
    run
}
