//! The report of a fleet as a JSON document.

use super::words::{answer, changes};
use crate::fleet::{FalseAlarms, FleetReport, Outlier, ReportedVehicle};
use crate::report::comparison::ComparisonDocument;
use serde::Serialize;
use std::collections::BTreeMap;

/// The document of `mavid fleet report`.
#[derive(Debug, Clone, Serialize)]
pub struct FleetDocument {
    schema: u32,
    verdict: &'static str,
    answer: String,
    vehicles: Vec<VehicleEntry>,
    without_history: Vec<String>,
    false_alarms: AlarmEntry,
    outliers: Vec<Outlier>,
    logs: BTreeMap<String, usize>,
    errors: Vec<ErrorEntry>,
}

#[derive(Debug, Clone, Serialize)]
struct VehicleEntry {
    name: String,
    #[serde(rename = "type")]
    kind: String,
    changed: bool,
    sentences: Vec<String>,
    flights: usize,
    flights_left_out: usize,
    start_utc_us: Option<Vec<i64>>,
    rotors: Vec<RotorEntry>,
    /// as `mavid compare --json` writes it
    comparison: ComparisonDocument,
}

/// Thrust for a command along the flights, over that of the mean rotor.
#[derive(Debug, Clone, Serialize)]
struct RotorEntry {
    name: String,
    /// by the autopilot's number, from 1
    motor: usize,
    thrust_per_command: Vec<(f64, f64)>,
}

#[derive(Debug, Clone, Serialize)]
struct AlarmEntry {
    #[serde(flatten)]
    alarms: FalseAlarms,
    rate: Option<f64>,
    rate_at_most: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct ErrorEntry {
    uri: String,
    why: String,
}

impl FleetDocument {
    /// The document of a report.
    #[must_use]
    pub fn new(report: &FleetReport) -> Self {
        let rate = report.alarms.rate();
        let error = |(uri, why): &(String, String)| ErrorEntry { uri: uri.clone(), why: why.clone() };
        Self {
            schema: 1,
            verdict: if report.changed().next().is_some() { "changed" } else { "nothing_changed" },
            answer: answer(report),
            vehicles: report.vehicles.iter().map(vehicle).collect(),
            without_history: report.without_history.clone(),
            false_alarms: AlarmEntry {
                alarms: report.alarms.clone(),
                rate: rate.map(|(rate, _)| rate),
                rate_at_most: rate.map(|(_, most)| most),
            },
            outliers: report.outliers.clone(),
            logs: report.logs.clone(),
            errors: report.errors.iter().map(error).collect(),
        }
    }
}

fn vehicle(of: &ReportedVehicle) -> VehicleEntry {
    let study = &of.history.study;
    let rotor = |(place, track): (usize, &Vec<(f64, f64)>)| RotorEntry {
        name: study.rotor(place).to_owned(),
        motor: place + 1,
        thrust_per_command: track.clone(),
    };
    VehicleEntry {
        name: of.history.name.clone(),
        kind: of.history.kind.clone(),
        changed: of.has_changed(),
        sentences: changes(of),
        flights: study.flights.len(),
        flights_left_out: of.history.left_out,
        start_utc_us: of.history.start_utc_us.clone(),
        rotors: study.rotors.iter().enumerate().map(rotor).collect(),
        comparison: ComparisonDocument::new(study),
    }
}
