//! Everything that the report says, put together once: page, JSON, model file and HTML read from here.

use super::located::Located;
use super::prediction::{Predicted, ShownOn};
use super::readers::for_readers;
use crate::diagnose::experiment::NextFlight;
use crate::diagnose::holdout::{Difference, HoldoutFit};
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::{CHANNELS, Empirical, ExplainSettings, Explanation, Fitted, Named, Nuisance, Verdict};
use crate::physics::ActiveEffect;
use crate::report::InputFile;
use crate::report::number::significant;
use crate::signals::Quality;
use crate::vehicle::{RigidBody, Vehicle};
use statrs::distribution::{ContinuousCDF, Normal};

/// A parameter with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// as in JSON
    pub name: &'static str,
    /// in `unit`
    pub value: f64,
    /// standard error
    pub std: f64,
    /// SI
    pub unit: &'static str,
}

/// What went in beside the recordings' signals.
#[derive(Debug, Clone)]
pub struct Given {
    /// nominal
    pub vehicle: Vehicle,
    /// flights that were explained
    pub inputs: Vec<InputFile>,
    /// where their signals come from
    pub quality: Vec<Quality>,
    /// settings of the method
    pub settings: ExplainSettings,
    /// s left out at the beginning of each flight
    pub transient_s: f64,
    /// what the user should know, sentence by sentence
    pub warnings: Vec<String>,
}

/// The whole answer.
#[derive(Debug, Clone)]
pub struct Story {
    /// what went in
    pub given: Given,
    /// what came out
    pub explanation: Explanation,
    /// named effects as readers want them
    pub effects: Vec<Named>,
    /// where nothing serves: what comes closest, likewise
    pub closest: Vec<Named>,
    /// errors of open-loop prediction on the flights that were explained
    pub identify: Option<Predicted>,
    /// and on those that were not used
    pub holdout: Option<Predicted>,
    /// everything that was shown on them
    pub shown: Option<HoldoutFit>,
    /// a term without a mechanism, where none serves
    pub empirical: Option<Empirical>,
    /// which those are
    pub shown_on: ShownOn,
    /// where simulation and recording differ
    pub located: Located,
    /// what to fly to tell apart what this flight cannot; `Err`: why there is none; `None`: not asked for
    pub next: Option<Result<NextFlight, String>>,
}

impl Story {
    /// Puts it together.
    #[must_use]
    pub fn new(given: Given, explanation: Explanation) -> Self {
        Self {
            effects: for_readers(&explanation.named),
            closest: for_readers(&explanation.closest),
            located: Located::of(&explanation),
            next: None,
            identify: None,
            holdout: None,
            shown: None,
            empirical: None,
            shown_on: ShownOn::Nothing { reason: "no hold-out".to_owned() },
            given,
            explanation,
        }
    }

    /// In one word.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.explanation.verdict
    }

    /// Mass and inertia of the final model.
    #[must_use]
    pub fn rigid_body(&self) -> Vec<Estimate> {
        rigid_body(self.fitted())
    }

    /// The fit that the model rests on: where nothing serves, that of the rigid body alone.
    #[must_use]
    pub fn fitted(&self) -> &Fitted {
        let search = &self.explanation.search;
        if self.verdict() == Verdict::Unexplained { &search.before } else { &search.after }
    }

    /// What shows that the hold-out is of another vehicle; `None` where it is not.
    #[must_use]
    pub fn other_vehicle(&self) -> Option<String> {
        Some(match &self.shown.as_ref()?.other_vehicle.as_ref()?.by {
            Difference::Parameter(by) => format!(
                "{} {} {unit} there, {} {unit} here",
                by.name,
                significant(by.held_out, 3),
                significant(by.identified, 3),
                unit = by.unit
            ),
            Difference::Residual { channel, ratio } => {
                format!("even a fit of its own leaves {ratio:.1} times as much of {channel} there as here")
            }
        })
    }

    /// The vehicle as identified.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.fitted().base.vehicle
    }

    /// Effects for the model file: those that were found, and a latency that was named.
    #[must_use]
    pub fn effects_of_model(&self) -> Vec<ActiveEffect> {
        let mut effects = Vec::new();
        if self.verdict() == Verdict::Unexplained {
            return effects;
        }
        effects.extend(self.found());
        if self.latency_named() {
            let latency = self.explanation.search.after.base.latency_effects();
            effects.extend(latency.iter().filter_map(|l| ActiveEffect::new(l.effect(), &l.values).ok()));
        }
        effects
    }

    /// The base's own effects beyond what was given; one isotropic drag in place of its two pieces.
    fn found(&self) -> Vec<ActiveEffect> {
        let base = &self.explanation.search.after.base;
        let entries = if self.verdict() == Verdict::Unexplained { &self.closest } else { &self.effects };
        // one isotropic drag has taken the place of the part along body z
        let merged = base.present.iter().find_map(|term| {
            let whole = term.signature.role.axial_part_of?;
            let entry = entries.iter().find(|effect| effect.id == whole.id())?;
            Some((whole, entry.get("dz")?.value))
        });
        let mut out = Vec::new();
        for present in &base.present {
            let mut values = present.values.clone();
            if let Some((whole, dz)) = merged {
                if present.signature.role.axial_part_of.is_some() {
                    continue;
                }
                if let Some(slot) = present.signature.role.axial.filter(|_| present.id() == whole.id()) {
                    values[slot] = dz;
                }
            }
            out.extend(ActiveEffect::new(present.effect(), &values).ok());
        }
        out
    }

    /// Chance of evidence this strong where the effect is absent: of the normal deviate, both sides.
    #[must_use]
    pub fn p_value(&self, effect: &Named) -> f64 {
        Normal::standard().sf(effect.strength.z.abs()) * 2.0
    }

    /// Change of the Bayesian information criterion by the effect: what its parameters cost less what they
    /// explain.
    #[must_use]
    pub fn delta_bic(&self, effect: &Named) -> f64 {
        let rows = (CHANNELS * self.explanation.search.after.rows.len()) as f64;
        effect.strength.count as f64 * rows.ln() - effect.strength.energy
    }

    /// A lag or delay is among the names.
    #[must_use]
    pub fn latency_named(&self) -> bool {
        let is_latency = |named: &Named| latency_kind(named.id).is_some();
        self.explanation.named.iter().chain(&self.explanation.closest).any(is_latency)
    }
}

/// Names of mass and inertia in the order of the paper's parameters.
pub const BODY_NAMES: [&str; 7] = ["mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// Mass (kg) and inertia (kg m^2) in the order of [`BODY_NAMES`].
#[must_use]
pub fn body_values(body: &RigidBody) -> [f64; 7] {
    let j = &body.inertia_kg_m2;
    [body.mass_kg, j[(0, 0)], j[(0, 1)], j[(0, 2)], j[(1, 1)], j[(1, 2)], j[(2, 2)]]
}

/// Mass and inertia of a fit with their standard errors.
#[must_use]
pub fn rigid_body(fitted: &Fitted) -> Vec<Estimate> {
    let values = body_values(&fitted.base.vehicle.body);
    BODY_NAMES
        .iter()
        .zip(values)
        .enumerate()
        .map(|(index, (name, value))| {
            let wanted = if index == 0 { Nuisance::Mass } else { Nuisance::Inertia(index - 1) };
            let place = fitted.rows.nuisances.iter().position(|column| column.nuisance == wanted);
            let std = place.map_or(f64::NAN, |at| fitted.covariance[(at, at)].max(0.0).sqrt());
            Estimate { name, value, std, unit: if index == 0 { "kg" } else { "kg m^2" } }
        })
        .collect()
}
