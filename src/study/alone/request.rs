//! Which log is studied, and how deep.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::study::{ReadSettings, VehicleGiven};

/// How deep a log is studied; each depth has all of those before it.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Depth {
    /// what is in the log
    Inspect,
    /// the balance of each flight, its power and its vibration
    Balance,
    /// the parameters that its motion shows, and the effects that the model lacks
    #[default]
    Explain,
}

/// One log by itself.
#[derive(Debug, Clone, Default)]
pub struct AloneRequest {
    /// the log
    pub log: PathBuf,
    /// how it is read
    pub read: ReadSettings,
    /// how deep
    pub depth: Depth,
}

/// What a log says of the vehicle that it is of.
#[derive(Debug, Clone, Copy)]
pub struct OwnWords<'a> {
    /// MAVLink system id, where its frames have one
    pub system: Option<u32>,
    /// `px4`, `ardupilot`, `other` or `unknown`
    pub autopilot: &'static str,
    /// the vehicle's parameters
    pub parameters: &'a BTreeMap<String, f64>,
}

/// The vehicle of a log, by what the log says; `None`: nothing is known but the autopilot's frame, and its balance is told in shares
/// and arms.
pub type Whose<'a> = dyn Fn(&OwnWords<'_>) -> Option<VehicleGiven> + 'a;
