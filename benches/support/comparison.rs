//! What the benchmarks `blind -- --vehicles` and `recorded` measured, as it is stored in `docs/measured-comparison.json`.
#![allow(dead_code, reason = "the benchmarks write it, the test of the book reads it")]

use serde::{Deserialize, Serialize};

/// The file's sections.
#[derive(Debug, Serialize, Deserialize)]
pub struct Comparison {
    pub pairs: Pairs,
    pub pooled: Pooled,
    pub cut_propellers: CutPropellers,
    pub simulators: Simulators,
    pub sessions: Sessions,
}

/// `--compared`: pairs of flights of one vehicle each.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Pairs {
    /// the command line that makes this section
    pub command: String,
    /// pairs of an unchanged vehicle
    pub unchanged: usize,
    /// of these called changed
    pub called_changed: usize,
    /// what is left of one rotor's thrust in the later flight of the other pairs
    pub factor: f64,
    /// pairs with such a rotor
    pub weakened: usize,
    /// of these found with the rotor
    pub found: usize,
    /// and no other explanation fits nearly as well
    pub alone: usize,
    /// and the factor lies within 1.96 standard errors
    pub covered: usize,
    /// smallest change of a rotor that would have been named, %: median over all pairs
    pub least_median_percent: f64,
    /// and the greatest
    pub least_greatest_percent: f64,
}

/// `--together`: the flights of a vehicle explained together.
#[derive(Debug, Serialize, Deserialize)]
pub struct Pooled {
    /// the command line that makes this section
    pub command: String,
    pub vehicles: usize,
    /// of each vehicle
    pub flights: u64,
    /// those of the vehicle whose truth is known to the benchmark
    pub parameters: Vec<PooledParameter>,
    /// all parameters, those of unknown truth as well
    pub all: PooledParameter,
}

/// A parameter over all vehicles.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct PooledParameter {
    pub name: String,
    pub vehicles: usize,
    /// the standard error is smaller than that of the best single flight
    pub smaller: usize,
    /// the truth is known
    pub known: usize,
    /// and lies within 1.96 standard errors
    pub covered: usize,
    /// the truth lies within 1.96 standard errors of the best single flight
    #[serde(default)]
    pub covered_by_single: usize,
    /// standard error over that of the best single flight, median
    pub error_ratio: f64,
}

/// `recorded`: real flights with whole and with cut propellers.
#[derive(Debug, Serialize, Deserialize)]
pub struct CutPropellers {
    /// the command line that makes this section
    pub command: String,
    pub cuts: Vec<Cut>,
}

/// The flights with one propeller.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Cut {
    /// 0: whole
    pub cut_mm: u32,
    /// each compared with the flights with whole propellers, itself excepted
    pub single: Vec<Answer>,
    /// all of them compared with those; `None`: whole
    pub together: Option<Answer>,
}

/// `recorded`: pairs of flights of both autopilots' simulators.
#[derive(Debug, Serialize, Deserialize)]
pub struct Simulators {
    /// the command line that makes this section
    pub command: String,
    pub pairs: Vec<SimulatedPair>,
}

/// A pair by both logs of its flights.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SimulatedPair {
    pub name: String,
    pub by_telemetry: Answer,
    pub on_board: Answer,
}

/// `recorded`: real flights of small quadrotors in three sessions.
#[derive(Debug, Serialize, Deserialize)]
pub struct Sessions {
    /// the command line that makes this section
    pub command: String,
    pub sessions: Vec<Session>,
    /// pairs of flights of one session, and of these called changed
    pub within: (usize, usize),
    /// pairs of flights of two sessions, and of these called changed
    pub between: (usize, usize),
}

/// Flights that belong together.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Session {
    pub flights: Vec<String>,
    /// what the accelerometer reads along x before the motors turn, m/s^2, each flight
    pub at_rest_m_s2: Vec<f64>,
    /// balance along x, along y (arms) and about z, mean of the flights
    pub balance: [f64; 3],
}

/// What `compare` answered.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Answer {
    pub earlier: Vec<String>,
    pub later: Vec<String>,
    /// the strongest change first; empty: nothing changed
    pub changes: Vec<FoundChange>,
    /// smallest change of a rotor that would have been named, %: the greatest of all rotors
    pub least_rotor_percent: f64,
}

/// A change that was named.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FoundChange {
    /// `rotor`, or what else changed
    pub what: String,
    /// number of the rotor's motor, from 1
    pub motor: Option<usize>,
    /// thrust for the same command over that before, or the later value
    pub after: Option<f64>,
    /// standard error of the difference
    pub std: Option<f64>,
    /// standard deviations
    pub sigmas: f64,
    /// other explanations that fit nearly as well
    pub rivals: usize,
}
