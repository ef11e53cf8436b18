//! Histories of many flights: vehicles one rotor of which becomes weak half way, and vehicles that stay as they are.
//!
//! A flight is made once and stands in several histories of its vehicle: each flight is drawn by itself, so any order of them is as likely
//! as another. 60 flights a vehicle give two histories with a change and ten without. With `--keep DIR` the rows of a vehicle's flights stay
//! in a file of that folder, and are not made again where they are there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use mavid::fleet::{
    FleetReport, LogRows, LogSettings, LogTask, ReportSettings, log_rows, rows_of_text, rows_text,
};
use mavid::study::{Changed, Depth};
use rand::RngExt;
use rayon::prelude::*;

use super::made::{LEFT, several_with};
use crate::maker::dice;
use crate::support::fleet::Histories;
use crate::support::recorded::alarms;

/// Flights of a history, and the first of them with the weak rotor.
const FLIGHTS: usize = 40;
const FROM: usize = FLIGHTS / 2;
/// Orders of a vehicle's whole flights.
const ORDERS: usize = 10;
/// Flights off the true one that a change may be told at.
const NEAR: usize = 2;

/// The flights of one vehicle as rows.
struct Flown {
    seed: u64,
    rotor: usize,
    whole: Vec<LogRows>,
    weak: Vec<LogRows>,
}

/// Makes the histories of `count` vehicles and reports them as one fleet. Rows of flights are kept in a folder where one is given.
pub fn run(seed: u64, count: u64, (shuffles, keep): (u32, Option<&Path>)) -> Histories {
    let began = Instant::now();
    let flown: Vec<Flown> = (seed..seed + count).filter_map(|seed| kept_or_flown(seed, keep)).collect();
    println!("{} of {count} vehicles flown in {:.0} s", flown.len(), began.elapsed().as_secs_f64());
    let (mut rows, mut truth) = (LogRows::default(), BTreeMap::new());
    for vehicle in &flown {
        for (name, flights, is_weak) in histories(vehicle) {
            truth.insert(name.clone(), is_weak.then_some(vehicle.rotor));
            flights.iter().enumerate().for_each(|(place, flight)| rows.extend(renamed(flight, &name, place)));
        }
    }
    let began = Instant::now();
    let report = FleetReport::of(&rows, &ReportSettings { false_alarms: 0.005, shuffles });
    println!("{} histories reported in {:.0} s", report.vehicles.len(), began.elapsed().as_secs_f64());
    let figures = figures(&report, &truth);
    tell(&figures);
    Histories { vehicles: flown.len(), ..figures }
}

/// The vehicle of a seed, from the folder if its rows are there.
fn kept_or_flown(seed: u64, keep: Option<&Path>) -> Option<Flown> {
    let file: Option<PathBuf> = keep.map(|folder| folder.join(format!("{seed}.json")));
    let kept = file.as_ref().and_then(|file| std::fs::read_to_string(file).ok());
    let rows = match kept {
        Some(text) => rows_kept(&text),
        None => {
            let rows = match flown(seed) {
                Ok(rows) => rows,
                Err(why) => {
                    println!("  seed {seed}: not flown: {why}");
                    return None;
                }
            };
            if let Some(file) = file {
                let texts: Vec<String> =
                    rows.iter().map(|rows| rows_text(rows).expect("rows as text")).collect();
                std::fs::create_dir_all(file.parent().expect("a file of a folder"))
                    .expect("a folder for rows");
                std::fs::write(file, serde_json::to_string(&texts).expect("texts")).expect("room for rows");
            }
            rows
        }
    };
    let mut whole = rows;
    let weak = whole.split_off(FLIGHTS);
    Some(Flown { seed, rotor: rotor(seed), whole, weak })
}

fn rows_kept(text: &str) -> Vec<LogRows> {
    let texts: Vec<String> = serde_json::from_str(text).expect("texts of rows");
    texts.iter().map(|text| rows_of_text(text).expect("rows of a flight")).collect()
}

/// The rotor of a vehicle that becomes weak.
fn rotor(seed: u64) -> usize {
    dice(seed, 14).random_range(0..4_usize)
}

/// Rows of the flights of the vehicle of a seed, the whole ones first.
fn flown(seed: u64) -> Result<Vec<LogRows>, String> {
    let folder = std::env::temp_dir().join(format!("mavid_history_{}_{seed}", std::process::id()));
    let weak = |flight: u64| (flight >= FLIGHTS as u64).then(|| rotor(seed));
    let made = several_with(&folder, seed, (FLIGHTS + FROM) as u64, &weak);
    let rows = made.map(|made| {
        let vehicles = format!("[[vehicle]]\nname = 'one'\nfile = {:?}\nlogs = '*'\n", made.file);
        let settings = LogSettings {
            depth: Depth::Balance,
            vehicles: toml::from_str(&vehicles).expect("a file of one vehicle"),
            ..LogSettings::default()
        };
        let of_flight = |path: &PathBuf| {
            let (uri, settings) = (path.display().to_string(), settings.clone());
            log_rows(&LogTask { sha256: uri.clone(), uri, path: path.clone(), bytes: 0, settings })
        };
        made.flights.par_iter().map(of_flight).collect()
    });
    let _ = std::fs::remove_dir_all(&folder);
    rows
}

/// Name, flights in order, and whether a rotor becomes weak.
fn histories(of: &Flown) -> Vec<(String, Vec<&LogRows>, bool)> {
    let mut all = Vec::new();
    for half in 0..2 {
        let whole = of.whole[half * FROM..(half + 1) * FROM].iter();
        let weak: Vec<&LogRows> =
            if half == 0 { of.weak.iter().collect() } else { of.weak.iter().rev().collect() };
        all.push((format!("{}-weak-{half}", of.seed), whole.chain(weak).collect(), true));
    }
    for order in 0..ORDERS {
        let mut flights: Vec<&LogRows> = of.whole.iter().collect();
        let mut dice = dice(of.seed, 100 + order as u64);
        for place in (1..flights.len()).rev() {
            flights.swap(place, dice.random_range(0..=place));
        }
        all.push((format!("{}-same-{order}", of.seed), flights, false));
    }
    all
}

/// The rows of a flight as the `place`th of a vehicle of this name.
fn renamed(flight: &LogRows, vehicle: &str, place: usize) -> LogRows {
    let mut rows = flight.clone();
    let log = format!("{vehicle}-{place}");
    let start = i64::try_from(place).expect("few flights");
    for row in &mut rows.logs {
        (row.log, row.uri) = (log.clone(), log.clone());
    }
    for row in &mut rows.flights {
        (row.log, row.vehicle, row.start_utc_us) = (log.clone(), vehicle.to_owned(), Some(start));
    }
    for row in &mut rows.legs {
        (row.log, row.vehicle) = (log.clone(), vehicle.to_owned());
    }
    for row in &mut rows.parameters {
        (row.log, row.vehicle) = (log.clone(), vehicle.to_owned());
    }
    for row in &mut rows.provenance {
        row.log.clone_from(&log);
    }
    rows
}

fn figures(report: &FleetReport, truth: &BTreeMap<String, Option<usize>>) -> Histories {
    let mut figures = Histories {
        flights: FLIGHTS,
        weak_flights: FROM,
        factor: LEFT,
        near: NEAR,
        alarms: alarms(&report.alarms),
        ..Histories::default()
    };
    for vehicle in &report.vehicles {
        let study = &vehicle.history.study;
        let steps: Vec<String> = study
            .history
            .iter()
            .map(|step| {
                let changes = &step.change.changes;
                let all: Vec<String> =
                    changes.iter().map(|change| format!("{:?} {:.1}", change.what, change.sigmas)).collect();
                format!("from {}: {}", step.from, all.join(", "))
            })
            .collect();
        match truth.get(&vehicle.history.name).copied().flatten() {
            None => {
                figures.unchanged += 1;
                figures.called_changed += usize::from(vehicle.has_changed());
                if vehicle.has_changed() {
                    println!("  {}: called changed: {}", vehicle.history.name, steps.join("; "));
                }
            }
            Some(rotor) => {
                figures.weakened += 1;
                let near = |from: usize| from.abs_diff(FROM) <= NEAR;
                let step = study.history.iter().find(|step| near(step.from));
                let is_named = step.is_some_and(|step| {
                    step.change.changes.iter().any(|one| one.what == Changed::Rotor(rotor))
                });
                figures.found += usize::from(step.is_some());
                figures.named += usize::from(is_named);
                if !is_named {
                    println!("  {}, rotor {rotor}: {}", vehicle.history.name, steps.join("; "));
                }
            }
        }
    }
    figures
}

fn tell(figures: &Histories) {
    println!(
        "{} of {} histories without a change were called changed",
        figures.called_changed, figures.unchanged
    );
    println!(
        "a rotor at {LEFT} from flight {} of {FLIGHTS} on: {} of {} found within {NEAR} flights, {} of them with the rotor",
        FROM + 1,
        figures.found,
        figures.weakened,
        figures.named
    );
    println!("{:?}", figures.alarms);
}
