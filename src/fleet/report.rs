//! The report of a fleet: which vehicles changed, when, and which differ from the others.

use std::collections::BTreeMap;

use super::alarms::{FalseAlarms, calibrated, judge};
use super::history::{VehicleHistory, histories};
use super::outliers::{Outlier, outliers};
use super::rows::LogRows;
use rayon::prelude::*;

/// The whole answer.
#[derive(Debug)]
pub struct FleetReport {
    /// vehicles with a history, by name
    pub vehicles: Vec<ReportedVehicle>,
    /// names of vehicles none of whose flights shows a balance
    pub without_history: Vec<String>,
    /// how often an unchanged vehicle is called changed
    pub alarms: FalseAlarms,
    /// vehicles that differ from the others of their type
    pub outliers: Vec<Outlier>,
    /// logs by their status
    pub logs: BTreeMap<String, usize>,
    /// addresses of logs that could not be read, and why
    pub errors: Vec<(String, String)>,
}

/// One vehicle of the report.
#[derive(Debug)]
pub struct ReportedVehicle {
    /// its flights, and where along them something changed
    pub history: VehicleHistory,
}

impl ReportedVehicle {
    /// Something changed along its flights.
    #[must_use]
    pub fn has_changed(&self) -> bool {
        self.history.study.has_changed()
    }
}

/// Settings of a report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportSettings {
    /// most unchanged vehicles that may be called changed, as a share
    pub false_alarms: f64,
    /// shuffled histories by which that is calibrated
    pub shuffles: u32,
}

impl FleetReport {
    /// The report of rows.
    #[must_use]
    pub fn of(rows: &LogRows, settings: &ReportSettings) -> Self {
        let (mut found, without_history) = histories(rows);
        let alarms = calibrated(&found, settings.false_alarms, settings.shuffles);
        found.par_iter_mut().for_each(|history| {
            let order: Vec<usize> = (0..history.study.flights.len()).collect();
            let steps = judge(history).history(&order, alarms.least_sigmas);
            history.study.history = steps;
        });
        let outliers = outliers(&found, settings.false_alarms);
        let mut logs = BTreeMap::new();
        rows.logs.iter().for_each(|log| *logs.entry(log.status.clone()).or_insert(0) += 1);
        let failed = rows.logs.iter().filter(|log| log.status == "error");
        let mut errors: Vec<(String, String)> =
            failed.map(|log| (log.uri.clone(), log.error.clone().unwrap_or_default())).collect();
        errors.sort();
        let reported = |history: VehicleHistory| ReportedVehicle { history };
        Self {
            vehicles: found.into_iter().map(reported).collect(),
            without_history,
            alarms,
            outliers,
            logs,
            errors,
        }
    }

    /// The vehicles that changed.
    pub fn changed(&self) -> impl Iterator<Item = &ReportedVehicle> {
        self.vehicles.iter().filter(|vehicle| vehicle.has_changed())
    }
}
