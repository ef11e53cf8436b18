//! A flight as typed streams on the vehicle's own clock.

use std::collections::BTreeMap;

use super::stream::{Stream, StreamKey};
use crate::autopilot::Autopilot;

/// A parameter that got another value while a flight was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterChange {
    /// s of the recording's clock: of the sample before it
    pub time_s: f64,
    /// name
    pub name: String,
    /// value until then, in the autopilot's own unit
    pub before: f64,
    /// value since then
    pub after: f64,
}

/// A flight of one vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recording {
    /// all streams
    pub streams: BTreeMap<StreamKey, Stream>,
    /// the vehicle's parameters as far as they were sent
    pub parameters: BTreeMap<String, f64>,
    /// what of them changed while it was recorded, in the order of time; [`Self::parameters`] has the last values
    pub parameter_changes: Vec<ParameterChange>,
    /// which autopilot wrote it
    pub autopilot: Autopilot,
    /// times at which the vehicle's clock started anew (reboot); no flight segment may span one
    pub clock_resets_s: Vec<f64>,
    /// times at which the position estimate jumped (ODOMETRY.reset_counter)
    pub estimator_resets_s: Vec<f64>,
    /// what the vehicle said
    pub texts: Vec<(f64, String)>,
}
