//! Settings, models and flights of the hold-out comparison.

use super::rate_law::RateLaw;
use crate::diagnose::empirical::Empirical;
use crate::diagnose::explain::ExplainSettings;
use crate::diagnose::explanation::Explanation;
use crate::recording::Recording;
use crate::signals::Signals;

/// Settings of the hold-out comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldoutSettings {
    /// s, half width of the weak form's test function
    pub half_width_s: f64,
    /// s, length of the resampled blocks
    pub block_s: f64,
    /// resamplings
    pub draws: usize,
    /// seed of resamplings and noise
    pub seed: u64,
    /// the held-out part belongs to the flight that was explained
    pub same_flight: bool,
    /// each flight has its own mass, by its beginning: of flights that were explained together
    pub own_mass: bool,
    /// the flights are seen with their own wind beside that of the model
    pub own_wind: bool,
}

impl Default for HoldoutSettings {
    fn default() -> Self {
        Self {
            half_width_s: ExplainSettings::default().half_width_s,
            block_s: 2.0,
            draws: 400,
            seed: 1,
            same_flight: false,
            own_mass: false,
            own_wind: false,
        }
    }
}

/// What predicts: an explanation, and what stands in where no mechanism serves.
#[derive(Debug, Clone, Copy)]
pub struct Explained<'a> {
    /// the rigid body and the better model
    pub explanation: &'a Explanation,
    /// a force beside the better model
    pub empirical: Option<&'a Empirical>,
    /// how the rates of both models move in open loop: it is no merit of the effects
    pub rate_law: Option<RateLaw>,
}

impl<'a> Explained<'a> {
    /// With nothing beside its effects.
    #[must_use]
    pub fn of(explanation: &'a Explanation) -> Self {
        Self { explanation, empirical: None, rate_law: None }
    }
}

/// A flight that was not used.
#[derive(Debug, Clone, Copy)]
pub struct HeldOut<'a> {
    /// its name in messages
    pub name: &'a str,
    /// conditioned with the vehicle file that the others were conditioned with
    pub signals: &'a Signals,
    /// with its setpoints, for the closed loop; `None`: it is left out
    pub recording: Option<&'a Recording>,
}
