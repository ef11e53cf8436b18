//! What is to be identified, and how.

use std::path::PathBuf;

use crate::diagnose::joint::RequestedEffects;
use crate::estimate::{IdentifySettings, PAPER_SIGMA};
use crate::signals::{ConditionSettings, STEP_FOR_EFFECTS_S, ThrustPreference};
use crate::study::explain::check_transient;
use crate::study::{ExplainRequest, ReadSettings, StudyError, VehicleGiven};

/// What is to be identified, and how.
#[derive(Debug, Clone)]
pub struct IdentifyRequest {
    /// recordings of one vehicle
    pub logs: Vec<PathBuf>,
    /// its file, or its mass and size
    pub vehicle: VehicleGiven,
    /// how the recordings are read
    pub read: ReadSettings,
    /// time left out at the beginning of the flight, s; `None`: 10, at most a fifth of the flight
    pub transient_s: Option<f64>,
    /// Hz, cut-off of the zero-phase low-pass; `None`: ten times the trajectory's highest harmonic
    pub cutoff_hz: Option<f64>,
    /// the 31-tap windowed filter in place of the Butterworth
    pub fir: bool,
    /// adaptation gain of gradient descent
    pub sigma: f64,
    /// commands even where rotor speeds are measured
    pub by_commands: bool,
    /// effects to identify together with the rigid body, by name
    pub with: Vec<String>,
}

impl Default for IdentifyRequest {
    fn default() -> Self {
        Self {
            logs: Vec::new(),
            vehicle: VehicleGiven::default(),
            read: ReadSettings::default(),
            transient_s: None,
            cutoff_hz: None,
            fir: false,
            sigma: PAPER_SIGMA,
            by_commands: false,
            with: Vec::new(),
        }
    }
}

impl IdentifyRequest {
    /// Checks what can be checked before a file is read.
    ///
    /// # Errors
    /// [`StudyError::Setting`].
    pub fn check(&self) -> Result<(), StudyError> {
        self.requested_effects()?;
        for (name, value) in [("sigma", Some(self.sigma)), ("cutoff", self.cutoff_hz)] {
            if let Some(value) = value.filter(|value| !value.is_finite() || *value <= 0.0) {
                let why = format!("expected a positive number, got {value}");
                return Err(StudyError::Setting { name, why });
            }
        }
        let filtered = self.cutoff_hz.is_some() || self.fir || self.sigma != PAPER_SIGMA;
        if filtered && !self.with.is_empty() {
            return Err(StudyError::FilterWithEffects);
        }
        self.transient_s.map_or(Ok(()), check_transient)?;
        self.read.check(self.logs.iter())
    }

    /// The effects that were asked for; `None` without any.
    pub(super) fn requested_effects(&self) -> Result<Option<RequestedEffects>, StudyError> {
        if self.with.is_empty() {
            return Ok(None);
        }
        let refuse = |why: &dyn std::fmt::Display| StudyError::Setting { name: "with", why: why.to_string() };
        RequestedEffects::of(&self.with).map(Some).map_err(|error| refuse(&error))
    }

    pub(super) fn settings(&self) -> IdentifySettings {
        IdentifySettings {
            cutoff_hz: self.cutoff_hz,
            fir: self.fir,
            sigma: self.sigma,
            ..IdentifySettings::default()
        }
    }

    /// Signals for the rigid body alone.
    pub(super) fn conditioning(&self) -> ConditionSettings {
        ConditionSettings {
            transient_s: self.transient_s,
            thrust: preference(self.by_commands),
            ..ConditionSettings::default()
        }
    }

    /// Signals for the rigid body with what is found beside it, as `explain` takes them.
    pub(super) fn conditioning_beside(&self) -> ConditionSettings {
        let best = if self.by_commands { ThrustPreference::Commands } else { ThrustPreference::BestSampled };
        ConditionSettings {
            transient_s: Some(self.transient_s.unwrap_or(ExplainRequest::TRANSIENT_S)),
            thrust: best,
            least_step_s: STEP_FOR_EFFECTS_S,
            ..ConditionSettings::default()
        }
    }

    /// Signals for the rigid body with effects: the rows on which `explain` would find them.
    pub(super) fn conditioning_with(&self, wanted: &RequestedEffects) -> ConditionSettings {
        ConditionSettings {
            transient_s: Some(self.transient_s.unwrap_or(ExplainRequest::TRANSIENT_S)),
            thrust: preference(self.by_commands || wanted.need_commands()),
            askew: wanted.turns_inertial_unit(),
            ..ConditionSettings::default()
        }
    }
}

fn preference(by_commands: bool) -> ThrustPreference {
    if by_commands { ThrustPreference::Commands } else { ThrustPreference::Measured }
}
