//! The result of explaining: what went in, what was found, and what shows it.

use super::along_flights::AlongFlights;
use super::left_out_force::LeftOutForce;
use super::limited::FlightLimit;
use super::located::Located;
use super::predicted::Predicted;
use super::readers::for_readers;
use super::refuted::Refuted;
use super::short::Short;
use super::validation_data::ValidationData;
use super::worth::Worth;
use crate::diagnose::experiment::{NextError, NextFlight};
use crate::diagnose::holdout::{Difference, HoldoutFit, RateLaw};
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::{
    AXES, ByPart, CHANNEL_NAMES, CHANNELS, Empirical, ExplainSettings, Explanation, Fitted, LatencyFinding,
    Named, Trace, Verdict,
};
use crate::draft::Draft;
use crate::estimate::{FlightApart, MovedByCurve};
use crate::note::Note;
use crate::physics::ActiveEffect;
use crate::signals::Quality;
use crate::study::{Correlation, InputFile};
use crate::text::significant;
use crate::vehicle::Vehicle;
use statrs::distribution::{ContinuousCDF, Normal};

/// What went in beside the recordings' signals.
#[derive(Debug, Clone)]
pub struct Given {
    /// nominal
    pub vehicle: Vehicle,
    /// flights that were explained
    pub inputs: Vec<InputFile>,
    /// where their signals come from
    pub quality: Vec<Quality>,
    /// V, mean of the battery in the air over those flights; `None` where none was recorded
    pub battery_voltage_v: Option<f64>,
    /// command of the motors at hover (0 to 1) and its standard error, where those flights tell it
    pub hover_command: Option<(f64, f64)>,
    /// how far mass and inertia move with one standard error of a guessed thrust curve
    pub by_guessed_curve: Option<MovedByCurve>,
    /// flights whose masses or moments of inertia, by the rigid body alone, contradict those of the first one
    pub contradicting: Vec<FlightApart>,
    /// why the flights that were explained tell little, by the way they were flown
    pub limited: Vec<FlightLimit>,
    /// one of those flights has a velocity and an attitude
    pub has_velocity: bool,
    /// settings of the method
    pub settings: ExplainSettings,
    /// s left out at the beginning of each flight
    pub transient_s: f64,
    /// the hold-outs have a mass of their own, by their beginning
    pub own_load: bool,
    /// the hold-outs are seen with their own wind in place of that of the flight explained
    pub own_wind: bool,
}

/// The whole answer.
#[derive(Debug)]
pub struct ExplainStudy {
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
    /// what each effect of the model is worth in prediction, where it has any
    pub worth: Option<Worth>,
    /// a term without a mechanism, where none serves
    pub empirical: Option<Empirical>,
    /// where there is such a term: errors of open-loop prediction on flights that were not used, without it
    pub without_empirical: Option<Predicted>,
    /// where flights that were not used were predicted with a load of their own: the same by the model as it is written
    pub as_written: Option<Predicted>,
    /// such a term that was left out, because flights that were not used are predicted worse with it
    pub left_out_force: Option<LeftOutForce>,
    /// a law of the rates for open-loop predictions, where the torques predict worse than no change
    pub rate_law: Option<RateLaw>,
    /// which flights those are
    pub shown_on: ValidationData,
    /// where simulation and recording differ
    pub located: Located,
    /// what to fly to distinguish what this flight cannot; `Err`: why there is none; `None`: not asked for
    pub next_flight: Option<Result<NextFlight, NextError>>,
    /// what the user should know, all of it warnings
    pub notes: Vec<Note>,
    /// why the flights cannot be of one vehicle
    pub(super) differing: Option<String>,
    /// named effects by each part of the flights, where a next flight is asked for
    pub by_part: Vec<ByPart>,
    /// names that were taken back, because flights that were not used refute them
    pub refuted: Option<Refuted>,
    /// effects that the flights explained show and the hold-out does not, each in brief with its size: they have no name
    pub withdrawn: Vec<String>,
    /// where one flight is too short for a part to be held back
    pub short: Option<Short>,
    /// the vehicle as it was drafted, where it came from no file
    pub drafted: Option<Draft>,
    /// of several flights: what they have in common, and what is each one's own
    pub along: Option<AlongFlights>,
    /// the flights that were explained as the weak form sees them
    pub(super) traces: Vec<Trace>,
    /// of several flights: see [`ExplainStudy::as_found`]
    pub(super) as_found: Option<Box<Explanation>>,
}

/// What is left of the equation of one axis, root mean square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisFit {
    /// as in [`CHANNEL_NAMES`]
    pub name: &'static str,
    /// N or N m
    pub unit: &'static str,
    /// by the rigid body alone
    pub before: f64,
    /// by the final model
    pub after: f64,
}

impl ExplainStudy {
    /// Puts it together, not shown on anything yet.
    #[must_use]
    pub fn new(given: Given, explanation: Explanation) -> Self {
        Self {
            effects: for_readers(&explanation.named, explanation.airspeed_m_s),
            closest: for_readers(&explanation.closest, explanation.airspeed_m_s),
            located: Located::of(&explanation),
            next_flight: None,
            identify: None,
            holdout: None,
            shown: None,
            worth: None,
            empirical: None,
            without_empirical: None,
            as_written: None,
            left_out_force: None,
            rate_law: None,
            shown_on: ValidationData::Nothing { reason: "no hold-out".to_owned() },
            notes: Vec::new(),
            differing: None,
            by_part: Vec::new(),
            refuted: None,
            withdrawn: Vec::new(),
            short: None,
            drafted: None,
            along: None,
            traces: Vec::new(),
            as_found: None,
            given,
            explanation,
        }
    }

    /// The explanation as it was found, before the values of several flights were put together: of these, they would be put together
    /// twice.
    pub(super) fn as_found(&self) -> &Explanation {
        self.as_found.as_deref().unwrap_or(&self.explanation)
    }

    /// The same with what was given.
    pub(super) fn into_found(self) -> (Given, Explanation) {
        (self.given, self.as_found.map_or(self.explanation, |found| *found))
    }

    /// The same with izz as the vehicle file states it, see [`Explanation::keeping_about_z`]: what is written and told.
    pub(super) fn keeping_about_z(self) -> Self {
        let about_z = |of: &Self| of.fitted().base.vehicle.body.inertia_kg_m2[(2, 2)];
        let told_kg_m2 = about_z(&self);
        let explanation = self.explanation.keeping_about_z(&self.given.vehicle);
        let mut kept = Self {
            effects: for_readers(&explanation.named, explanation.airspeed_m_s),
            closest: for_readers(&explanation.closest, explanation.airspeed_m_s),
            explanation,
            ..self
        };
        let factor = about_z(&kept) / told_kg_m2;
        let of_each = kept.along.iter_mut().flat_map(|along| along.tracks.iter_mut());
        of_each.filter(|track| track.turns_about_z()).for_each(|track| track.scale(factor));
        kept
    }

    /// In one word.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.explanation.verdict
    }

    /// The fit that the model rests on: where nothing serves, that of the rigid body alone.
    pub(super) fn fitted(&self) -> &Fitted {
        let search = &self.explanation.search;
        if self.verdict() == Verdict::Unexplained { &search.before } else { &search.after }
    }

    /// The vehicle as identified.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.fitted().base.vehicle
    }

    /// Where what the found effects leave differs from the recording.
    #[must_use]
    pub fn left_over(&self) -> Located {
        Located::left(&self.explanation)
    }

    /// From command to rotor.
    #[must_use]
    pub fn latency(&self) -> &LatencyFinding {
        &self.explanation.search.latency
    }

    /// Forces and torques that are compared, of all axes.
    pub(super) fn compared_axes(&self) -> impl Iterator<Item = usize> {
        (0..AXES).filter(|&axis| self.explanation.search.before.rows.count_of(axis) > 0)
    }

    /// Factor of the final model's scale of force over that of the rigid body alone.
    pub(super) fn scale_over_alone(&self) -> f64 {
        let search = &self.explanation.search;
        search.after.base.scale_over(&search.before.base)
    }

    /// What is left of each axis that is compared.
    #[must_use]
    pub fn residual(&self) -> Vec<AxisFit> {
        let search = &self.explanation.search;
        let (before, after) = (search.before.weighted.sigma, search.after.weighted.sigma);
        let scale = self.scale_over_alone();
        let axis = |index: usize| AxisFit {
            name: CHANNEL_NAMES[index],
            unit: unit_of(CHANNEL_NAMES[index]),
            before: scale * before[index],
            after: after[index],
        };
        self.compared_axes().map(axis).collect()
    }

    /// How the errors of the final model's parameters go together.
    #[must_use]
    pub fn correlation(&self) -> Correlation {
        Correlation::of_fit(self.fitted())
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
                format!("even after its own fit, the residual of {channel} is {ratio:.1} times the one here")
            }
            Difference::Rotor { name } => format!("{name} here, not there"),
        })
    }

    /// Effects for the model file: those that were found, and a latency that was named. What one of several flights has alone is not the
    /// vehicle's.
    #[must_use]
    pub fn effects_of_model(&self) -> Vec<ActiveEffect> {
        let mut effects = Vec::new();
        if self.verdict() == Verdict::Unexplained {
            return effects;
        }
        let of_one =
            |id: &str| self.along.as_ref().is_some_and(|along| along.flight_with_alone(id).is_some());
        effects.extend(self.found().into_iter().filter(|active| !of_one(active.effect().id())));
        if self.latency_named() {
            let latency = self.explanation.search.after.base.latency_effects();
            effects.extend(latency.iter().filter_map(|l| ActiveEffect::new(l.effect(), &l.values).ok()));
        }
        effects
    }

    /// The base's own effects beyond what was given; one isotropic drag in place of its two pieces.
    fn found(&self) -> Vec<ActiveEffect> {
        let base = &self.explanation.search.after.base;
        // one isotropic drag has taken the place of the part along body z
        let merged = base.effects.iter().find_map(|term| {
            let whole = term.signature.role.axial_part_of?;
            let entry = self.effects.iter().find(|effect| effect.id == whole.id())?;
            Some((whole, entry.get("dz")?.value))
        });
        let mut out = Vec::new();
        for present in &base.effects {
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

    /// The files of the flights that were not used; none where a part of a flight was held back.
    #[must_use]
    pub fn held_out_inputs(&self) -> &[InputFile] {
        if let ValidationData::Flights(inputs) = &self.shown_on { inputs } else { &[] }
    }

    /// Every recording that went in.
    pub fn inputs(&self) -> impl Iterator<Item = &InputFile> {
        self.given.inputs.iter().chain(self.held_out_inputs())
    }
}

/// Unit of what is left of an axis.
fn unit_of(channel: &str) -> &'static str {
    if channel.starts_with("force") { "N" } else { "N m" }
}
