//! What `cargo bench --bench explain` measured, as it is stored in `docs/measured.json`. The book is made from it.
#![allow(dead_code, reason = "the benchmark writes it, the test of the book reads it")]

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One run of the benchmark.
#[derive(Debug, Serialize, Deserialize)]
pub struct Measured {
    /// the command line that makes this file
    pub command: String,
    /// of the first flight of each part
    pub seed: u64,
    pub clean: Clean,
    pub effects: Vec<EffectRun>,
    pub pairs: Vec<PairRun>,
    pub limits: Vec<Limit>,
    /// of the first flight of each effect
    pub pictures: Vec<Picture>,
}

/// Flights in which nothing is concealed.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Clean {
    pub flights: usize,
    /// a name was given
    pub named: usize,
    /// any verdict but `nothing_missing`
    pub found: usize,
}

/// Flights in which one effect is concealed.
#[derive(Debug, Serialize, Deserialize)]
pub struct EffectRun {
    pub id: String,
    pub flights: usize,
    pub named: usize,
    /// not named, and in the confusable set of a named effect
    pub in_set: usize,
    /// neither; stated as a trace: certain, and too small to matter
    #[serde(default)]
    pub traces: usize,
    /// names that are neither, with their number
    pub others: BTreeMap<String, usize>,
    pub verdicts: BTreeMap<String, usize>,
    /// median over flights and parameters of the error of size, %
    pub size_error_percent: Option<f64>,
    /// by effect: in the confusable set of the right name
    pub confusable: BTreeMap<String, Confused>,
}

/// How often an effect was in the confusable set of another one.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Confused {
    pub flights: usize,
    /// smallest distance between both, standard deviations
    pub least_distance: Option<f64>,
}

/// Flights in which two effects are concealed.
#[derive(Debug, Serialize, Deserialize)]
pub struct PairRun {
    pub effects: [String; 2],
    pub flights: usize,
    /// both are named, or in the confusable set of a name
    pub both: usize,
    /// and nothing else is named
    pub exact: usize,
}

/// The smallest size that would have been named, over flights in which nothing is concealed.
#[derive(Debug, Serialize, Deserialize)]
pub struct Limit {
    pub id: String,
    pub parameter: String,
    pub unit: String,
    pub median: f64,
    /// 90th percentile
    pub most: f64,
}

/// The residual of a flight with an effect, before it was found and after.
#[derive(Debug, Serialize, Deserialize)]
pub struct Picture {
    pub id: String,
    pub panels: Vec<Chart>,
}

/// One panel of a picture.
#[derive(Debug, Serialize, Deserialize)]
pub struct Chart {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub x: Vec<f64>,
    /// of the rigid body
    pub before: Vec<f64>,
    /// of the model found
    pub after: Vec<f64>,
    /// ends of the interval of 95 % about `before`, where there is one
    pub low: Vec<f64>,
    pub high: Vec<f64>,
}
