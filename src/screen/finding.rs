//! What is notable in a log.

use serde::Serialize;

/// How grave a finding is; the order is from little to much.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Gravity {
    /// good to know
    Info,
    /// the vehicle differs from its model, or the log is damaged
    Warning,
    /// the vehicle cannot fly so
    Critical,
}

/// Where in the log a finding shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Where {
    /// quantity of the stream that shows it, as `inspect` calls it
    pub quantity: &'static str,
    /// value of that stream, from 0
    pub channel: usize,
}

/// A number of a finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Amount {
    /// of what
    pub name: String,
    /// in `unit`
    pub value: f64,
    /// standard error, in `unit`; `None`: none is known
    pub std: Option<f64>,
    /// SI, `1` for a ratio
    pub unit: &'static str,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// `output_off_mixer`, `off_balance`, `data_lost`, or the identifier of an effect
    pub id: &'static str,
    /// how grave it is
    pub gravity: Gravity,
    /// for a person
    pub sentence: String,
    /// s of the vehicle's clock since the beginning of the log: from and to; `None`: the whole log
    pub span_s: Option<(f64, f64)>,
    /// where it shows best
    pub at: Option<Where>,
    /// its numbers
    pub amounts: Vec<Amount>,
    /// what explains the log as well, by identifier or in words; empty: nothing that is known
    pub may_be: Vec<String>,
}

/// What one log shows.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct Screening {
    /// name of the format
    pub format: &'static str,
    /// time in the air that was looked at, s
    pub airborne_s: f64,
    /// the gravest first
    pub findings: Vec<Finding>,
    /// what was not looked at, and why, sentence by sentence: no finding there says nothing
    pub not_done: Vec<String>,
}
