//! What the benchmarks `coverage` and `with` measured, as it is stored in `docs/measured-identification.json`.
#![allow(dead_code, reason = "the benchmarks write it, the test of the book reads it")]

use serde::{Deserialize, Serialize};

/// The file's sections.
#[derive(Debug, Serialize, Deserialize)]
pub struct Identification {
    pub coverage: Coverage,
    pub joint: Joint,
    /// `slung_load` alone, on more flights
    pub slung_load: Joint,
}

/// `cargo bench --bench coverage`: intervals of `identify` on flights of random vehicles.
#[derive(Debug, Serialize, Deserialize)]
pub struct Coverage {
    /// the command line that makes this section
    pub command: String,
    /// identified
    pub flights: usize,
    /// the trajectory was beyond the vehicle
    pub not_flown: usize,
    pub methods: Vec<MethodCoverage>,
}

/// One method of estimation.
#[derive(Debug, Serialize, Deserialize)]
pub struct MethodCoverage {
    /// `WEAK`, `LS`, `FMLS`, or `best`: the one that `identify` recommends
    pub method: String,
    pub flights: usize,
    pub parameters: Vec<ParameterCoverage>,
}

/// One parameter over all flights.
#[derive(Debug, Serialize, Deserialize)]
pub struct ParameterCoverage {
    pub name: String,
    /// flights in which the truth lies within 1.96 standard errors
    pub covered: usize,
    /// root mean square of error over standard error
    pub error_over_std: f64,
    /// of the absolute error, % of the size
    pub median_error_percent: f64,
    /// of the signed error, % of the size
    pub mean_error_percent: f64,
    /// 90th percentile of the absolute error, % of the size
    pub high_error_percent: f64,
}

/// `cargo bench --bench with`: effects that were concealed and estimated on request.
#[derive(Debug, Serialize, Deserialize)]
pub struct Joint {
    /// the command line that makes this section
    pub command: String,
    pub sets: Vec<JointSet>,
}

/// Flights in which one set of effects was concealed and asked for. A parameter counts if its effect had an amount of it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct JointSet {
    pub effects: Vec<ConcealedEffect>,
    /// identified
    pub flights: usize,
    /// ended with an error
    pub failed: usize,
    /// parameters that were estimated
    pub determined: usize,
    /// parameters that the flight does not determine, by the program's own words
    pub not_determined: usize,
    /// parameters that ended at a bound
    pub at_bound: usize,
    /// of the determined ones: within 20 % of the amount
    pub near: usize,
    /// of the determined ones: within three standard errors
    pub covered: usize,
    /// root mean square of error over standard error; 0: nothing was determined
    pub error_over_std: f64,
    /// largest error, % of the amount
    pub worst_error_percent: f64,
}

/// An effect with the parameters that had an amount.
#[derive(Debug, Serialize, Deserialize)]
pub struct ConcealedEffect {
    pub id: String,
    pub parameters: Vec<String>,
}
