//! What `cargo bench --bench blind -- --realistic` measured, as it is stored in `docs/measured-realistic.json`.
#![allow(dead_code, reason = "the benchmark writes it, the test of the book reads it")]

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One run of the benchmark.
#[derive(Debug, Serialize, Deserialize)]
pub struct Realistic {
    /// the command line that makes this file
    pub command: String,
    /// of the first flight of each part
    pub seed: u64,
    pub clean: CleanFlights,
    pub effects: Vec<EffectFlights>,
    /// with two and four effects
    pub several: SeveralFlights,
    /// stated sizes of effects
    pub sizes: Intervals,
    /// stated masses and moments of inertia
    pub bodies: Intervals,
    pub localisation: Localised,
}

/// Flights in which nothing is concealed.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct CleanFlights {
    pub flights: usize,
    /// a name was given
    pub named: usize,
    /// `unexplained`, without a name
    pub unexplained: usize,
    /// one-sided 95 % bound by Clopper and Pearson of the share that is named, percent
    pub bound_percent: f64,
    /// how often
    pub names: BTreeMap<String, usize>,
}

/// Flights in which one effect is concealed.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct EffectFlights {
    pub id: String,
    pub flights: usize,
    /// named or in a set, and nothing else named
    pub right: usize,
    pub named: usize,
    /// not named, and in the confusable set of a named effect
    pub in_set: usize,
    /// false names, with their number
    pub others: BTreeMap<String, usize>,
    /// errors of the mass and of the moments of inertia of the rigid body alone
    pub without: Bias,
    /// the same with what was named, where the effect was
    pub with: Bias,
}

/// Errors, percent: mean of the signed ones of the mass, median of the absolute ones of the moments of inertia.
#[derive(Debug, Default, Clone, Copy, Serialize, Deserialize)]
pub struct Bias {
    pub mass: Option<f64>,
    pub inertia: Option<f64>,
}

/// Flights with several effects.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct SeveralFlights {
    pub flights: usize,
    pub right: usize,
    /// effects that were concealed, and of them named or in a set
    pub concealed: usize,
    pub found: usize,
    pub others: BTreeMap<String, usize>,
}

/// Stated values with their standard errors.
#[derive(Debug, Default, Clone, Copy, Serialize, Deserialize)]
pub struct Intervals {
    pub stated: usize,
    /// within 10 % of the truth; of a mass 2 %
    pub near: usize,
    /// the truth lies within 1.96 standard errors
    pub inside: usize,
    /// within two standard errors
    pub two: usize,
    /// near, and within three standard errors
    pub right: usize,
}

/// Axes, force and torque, on which something is said to be missing.
#[derive(Debug, Default, Clone, Copy, Serialize, Deserialize)]
pub struct Localised {
    /// said and so, said and not so, not said and so
    pub hits: usize,
    pub wrong: usize,
    pub missed: usize,
    /// harmonic mean of precision and recall
    pub f1: f64,
}
