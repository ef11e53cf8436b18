//! The model so far: rigid body, actuation latency, and the effects that were accepted.

use crate::physics::effects::by_id;
use crate::physics::{ActiveEffect, Effect, Model, Parameter, PhysicsError};
use crate::signals::ActuationLatency;
use crate::vehicle::Vehicle;
use nalgebra::Matrix3;

/// An effect with its values, and which of them are estimated.
#[derive(Debug, Clone)]
pub struct Present {
    /// which
    pub effect: &'static dyn Effect,
    /// in the order of [`Effect::parameters`], then of [`Effect::finer_parameters`]
    pub values: Vec<f64>,
    /// indices of those that are estimated
    pub free: Vec<usize>,
}

impl Present {
    /// The parameter of a slot of the values; `None` beyond the last.
    #[must_use]
    pub fn parameter(&self, slot: usize) -> Option<&'static Parameter> {
        self.effect.parameters().iter().chain(self.effect.finer_parameters()).nth(slot)
    }

    /// The value that physics allows nearest to this.
    #[must_use]
    pub fn possible(&self, slot: usize, value: f64) -> f64 {
        self.parameter(slot).map_or(value, |parameter| value.clamp(parameter.min, parameter.max))
    }

    /// How far a parameter is from where its effect vanishes, in its unit: what its column has to be multiplied by to
    /// give the effect.
    #[must_use]
    pub fn from_nothing(&self, slot: usize) -> f64 {
        match self.effect.id() {
            // it divides: nothing lies at infinity, and the distance to it is in the inverse
            "ceiling_effect" if slot == 0 => -self.values[slot],
            _ => self.values[slot] - self.nothing_at(slot),
        }
    }

    /// The same in standard errors of `std`.
    #[must_use]
    pub fn away_from_nothing(&self, slot: usize, std: f64) -> f64 {
        self.from_nothing(slot) / std.max(f64::MIN_POSITIVE)
    }

    /// Whether a parameter says how much of the effect there is; the others say what it is like.
    #[must_use]
    pub fn is_amount(&self, slot: usize) -> bool {
        match self.effect.id() {
            "slung_load" | "ceiling_effect" => slot == 0,
            "mass_change" | "weak_rotor" => slot == 1,
            "tether" | "ground_effect" => slot < 2,
            _ => slot < self.effect.parameters().len(),
        }
    }

    /// Value at which a parameter's effect vanishes.
    #[must_use]
    pub fn nothing_at(&self, slot: usize) -> f64 {
        match (self.effect.id(), slot) {
            ("weak_rotor", 1) => 1.0,
            // it divides
            ("ceiling_effect", 0) => self.parameter(slot).map_or(0.0, |parameter| parameter.max),
            _ => 0.0,
        }
    }
}

/// Where a coefficient of a candidate's column takes the parameter.
pub(super) fn moved_to(present: &Present, index: usize, by: f64) -> f64 {
    let from = present.values[index];
    if present.effect.id() == "ceiling_effect" && from == present.nothing_at(index) {
        // so much of a usual ceiling's, and the effect goes with the inverse
        let share = by / (USUAL_CEILING - from);
        return if share > 0.0 { USUAL_CEILING / share } else { from };
    }
    from + by
}

/// a1 of ceilings that were measured.
const USUAL_CEILING: f64 = 5.0;

/// By how much a parameter is moved to see what it does.
pub(super) fn step_of(present: &Present, index: usize) -> f64 {
    if present.effect.id() == "ceiling_effect" && present.values[index] == present.nothing_at(index) {
        // a1 divides, and is taken to a usual ceiling's at once: its slope at nothing leads nowhere
        return USUAL_CEILING - present.values[index];
    }
    let span = present.parameter(index).map_or(1.0, |parameter| (parameter.max - parameter.min).min(1.0));
    (1e-4 * span).max(1e-3 * present.values[index].abs())
}

/// A load to start from is no more than this share of the mass.
const MOST_OF_MASS: f64 = 0.5;

/// A load that was in the mass `all_kg` (kg) of a rigid body until now: returns the vehicle's own, kg. Its swing is that
/// of the measured motion, whatever the load.
pub(super) fn lift_load(load: &mut Present, all_kg: f64) -> f64 {
    load.values[0] = load.values[0].min(MOST_OF_MASS * all_kg);
    all_kg - load.values[0]
}

/// What the recording is compared with.
#[derive(Debug, Clone)]
pub struct Base {
    /// with mass and inertia as now estimated
    pub vehicle: Vehicle,
    /// between command and rotor
    pub latency: ActuationLatency,
    /// beside the rigid body
    pub present: Vec<Present>,
}

impl Base {
    /// A rigid body alone.
    #[must_use]
    pub fn rigid(vehicle: &Vehicle) -> Self {
        Self { vehicle: vehicle.clone(), latency: ActuationLatency::default(), present: Vec::new() }
    }

    /// Some of an effect's parameters are estimated.
    #[must_use]
    pub fn estimates(&self, id: &str) -> bool {
        self.present.iter().any(|present| present.effect.id() == id && !present.free.is_empty())
    }

    /// The model with its effects, and `more` of them.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle is not physical or lacks what an effect needs.
    pub fn model(&self, more: &[Present]) -> Result<Model, PhysicsError> {
        let effects = self
            .present
            .iter()
            .chain(more)
            .map(|present| ActiveEffect::new(present.effect, &present.values))
            .collect::<Result<Vec<_>, _>>()?;
        // along a recording only force and torque are asked for; while the search goes on, the inertia may
        // be what no body has
        let mut vehicle = self.vehicle.clone();
        vehicle.body.inertia_kg_m2 = positive(&vehicle.body.inertia_kg_m2);
        Model::new(&vehicle, effects)
    }

    /// The latency as effects, for simulations; a delay below zero, which only the log's own stamps can
    /// make, is none.
    #[must_use]
    pub fn latency_effects(&self) -> Vec<Present> {
        let ActuationLatency { delay_s, lag_s, uneven } = self.latency;
        let of = |id: &str, values: Vec<f64>| {
            let effect = by_id(id).filter(|_| values[0] > 0.0)?;
            Some(Present { effect, values, free: Vec::new() })
        };
        let (rising_s, falling_s) = self.latency.rising_and_falling_s();
        let lags_s = if uneven == 0.0 { vec![lag_s] } else { vec![rising_s, falling_s] };
        [of("motor_lag", lags_s), of("transport_delay", vec![delay_s])].into_iter().flatten().collect()
    }
}

/// The inertia with its principal moments held above a thousandth of the largest.
fn positive(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let mut eigen = inertia.symmetric_eigen();
    let least = 1e-3 * eigen.eigenvalues.amax();
    eigen.eigenvalues.iter_mut().for_each(|moment| *moment = moment.max(least));
    let raised = eigen.recompose();
    0.5 * (raised + raised.transpose())
}

/// The effect that a large tilt of the thrust is.
pub(super) const THRUST_TILT: &str = "thrust_tilt";

/// The effect that a large error of the attitude's level is.
pub(super) const FRAME_MISALIGNMENT: &str = "frame_misalignment";

/// Where an attitude that is turned with its frame comes in place of the nuisance for its level.
const WITH_ATTITUDE: usize = 3;

/// The base has an effect for an attitude that is not level.
pub(super) fn turns_attitude(base: &Base) -> bool {
    base.estimates(FRAME_MISALIGNMENT)
        && base.present.iter().any(|present| {
            present.effect.id() == FRAME_MISALIGNMENT
                && present.values.get(WITH_ATTITUDE).is_none_or(|share| *share > 0.0)
        })
}
