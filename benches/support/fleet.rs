//! What the benchmarks `blind -- --vehicles --history` and `recorded -- --history` measured, as it is stored in
//! `docs/measured-fleet.json`.
#![allow(dead_code, reason = "the benchmarks write it, the test of the book reads it")]

use serde::{Deserialize, Serialize};

/// The file's sections.
#[derive(Debug, Serialize, Deserialize)]
pub struct Fleet {
    pub histories: Histories,
    pub cut_propellers: CutHistory,
}

/// `--history`: simulated histories, some with a rotor that becomes weak, reported as one fleet.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Histories {
    /// the command line that makes this section
    pub command: String,
    pub vehicles: usize,
    /// of a history
    pub flights: usize,
    /// flights of each vehicle with the weak rotor
    pub weak_flights: usize,
    /// what is left of the rotor's thrust and torque
    pub factor: f64,
    /// histories with a weak rotor from the half on
    pub weakened: usize,
    /// of these found near the flight
    pub found: usize,
    /// and named as that rotor
    pub named: usize,
    /// how many flights off the true one still count as found
    pub near: usize,
    /// histories without a change
    pub unchanged: usize,
    /// of these called changed
    pub called_changed: usize,
    pub alarms: Alarms,
}

/// The bound by shuffled histories.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Alarms {
    /// standard deviations that a change needs
    pub least_sigmas: f64,
    /// shuffled histories
    pub shuffled: usize,
    /// of these called changed
    pub called: usize,
    /// largest rate that agrees with that count at 95 %, %
    pub greatest_rate_percent: f64,
}

/// `recorded -- --history`: real flights with whole propellers, then with cut ones.
#[derive(Debug, Serialize, Deserialize)]
pub struct CutHistory {
    /// the command line that makes this section
    pub command: String,
    /// cut of the propeller in each flight, mm; 0: whole
    pub cuts_mm: Vec<u32>,
    pub steps: Vec<FoundStep>,
    pub alarms: Alarms,
}

/// Where the history changed.
#[derive(Debug, Serialize, Deserialize)]
pub struct FoundStep {
    /// first flight after the change, from 1
    pub flight: usize,
    /// number of the rotor's motor, from 1, if a rotor is named
    pub motor: Option<usize>,
    /// thrust for the same command over that before
    pub after: Option<f64>,
    /// standard error of the difference
    pub std: Option<f64>,
}
