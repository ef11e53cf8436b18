//! The model so far: rigid body, actuation latency, and the effects that were accepted.

use super::channels::Nuisance;
use super::signature::{EffectTerm, LatencyKind};
use super::signatures::latency_signature;
use crate::physics::{ActiveEffect, ActuationLatency, Model, PhysicsError, RotorLag};
use crate::vehicle::{Anchor, Guessed, Vehicle, VehicleSize};
use nalgebra::{Matrix3, Vector3};

/// Largest share of the total mass that a slung load may have at the start of a fit. Beyond it the load flies the
/// vehicle.
const MOST_OF_MASS: f64 = 0.5;

/// Separates a slung load from the mass `all_kg` (kg) that a rigid body had until now. Returns the vehicle's own mass,
/// kg.
pub(super) fn lift_load(load: &mut EffectTerm, all_kg: f64) -> f64 {
    load.values[0] = load.values[0].min(MOST_OF_MASS * all_kg);
    all_kg - load.values[0]
}

/// The model with which the recording is compared.
#[derive(Debug, Clone)]
pub struct Base {
    /// with the current estimates of mass and inertia
    pub vehicle: Vehicle,
    /// size by the vehicle file: the plausible range of an effect does not change while the mass is estimated
    pub size: VehicleSize,
    /// between command and rotor
    pub latency: ActuationLatency,
    /// effects in addition to the rigid body
    pub effects: Vec<EffectTerm>,
    /// kg: the vehicle has this mass, and the scale of its thrust is estimated; `None`: the stated thrust is trusted, and the
    /// mass is estimated
    pub weighed_kg: Option<f64>,
    /// the scale is that of the stated mass and of the stated thrust together, as a bent thrust curve leaves both: by how many standard
    /// errors they differ
    pub stated_mass_differs: Option<f64>,
    /// a simulator flew, and it leaves the gyroscopic torque out: the share that acts is estimated
    pub estimates_gyroscopic: bool,
    /// the accelerometer is taken to be without bias, because the bias that fitted best is no accelerometer's
    pub is_unbiased: bool,
    /// inertia of the vehicle that the base began with, kg m^2: about its products lies what is known of them
    pub begun_kg_m2: Matrix3<f64>,
}

/// Force, mass and inertia follow the scale of thrust; lengths, angles, times and ratios do not.
pub(crate) fn follows_force(unit: &str) -> bool {
    unit.starts_with('N') || unit.starts_with("kg")
}

/// Whether a value of an effect is known as a ratio to the rotors' torque per thrust: a moment about z, or the inertia of rotors that spin up.
#[must_use]
pub fn turns_about_z(name: &str, unit: &str) -> bool {
    unit == "kg m^2" || unit.starts_with("N m") && name.ends_with('z')
}

impl Base {
    /// Takes a wind out of a model without an effect of the air, through which alone it acts.
    pub(super) fn drop_wind_alone(&mut self) {
        if self.effects.iter().all(|term| !term.signature.role.of_air) {
            self.effects.retain(|term| term.signature.role.wind.is_none());
        }
    }

    /// Factor of the scale of force over that of another model of the same flights, beside a bent thrust curve: residuals of both, N and N m,
    /// are compared on one scale.
    #[must_use]
    pub fn scale_over(&self, other: &Self) -> f64 {
        let full_n = |base: &Self| base.vehicle.propulsion.full_thrust_n();
        if self.stated_mass_differs.is_some() { full_n(self) / full_n(other) } else { 1.0 }
    }

    /// The model without some of its effects, by their places.
    pub(super) fn without(&self, leaves: impl Fn(usize) -> bool) -> Self {
        let mut left = self.clone();
        let mut places = 0..;
        left.effects.retain(|_| places.next().is_some_and(|place| !leaves(place)));
        left.drop_wind_alone();
        left
    }

    /// Steady wind of the model in the world frame (NWU), m/s; zero where it has none.
    pub(crate) fn wind_m_s(&self) -> Vector3<f64> {
        let wind = self.effects.iter().find(|term| term.signature.role.wind.is_some());
        wind.map_or(Vector3::zeros(), |wind| Vector3::from_row_slice(&wind.values[..3]))
    }

    /// A rigid body alone.
    #[must_use]
    pub fn rigid(vehicle: &Vehicle) -> Self {
        Self {
            vehicle: vehicle.clone(),
            size: vehicle.size(),
            latency: ActuationLatency::default(),
            effects: Vec::new(),
            weighed_kg: None,
            stated_mass_differs: None,
            estimates_gyroscopic: false,
            is_unbiased: false,
            begun_kg_m2: vehicle.body.inertia_kg_m2,
        }
    }

    /// A rigid body alone on the scale that the vehicle's anchor sets: with a weighed mass no full thrust is a guess.
    #[must_use]
    pub fn anchored(vehicle: &Vehicle) -> Self {
        let mut base = Self::rigid(vehicle);
        if vehicle.anchor == Anchor::Mass {
            base.weighed_kg = Some(vehicle.body.mass_kg);
            base.vehicle.guesses.retain(|guess| guess.of != Guessed::ThrustMax);
        }
        base
    }

    /// The same with the gyroscopic torque of another base.
    pub(super) fn turning_as(mut self, other: &Self) -> Self {
        self.vehicle.body.gyroscopic = other.vehicle.body.gyroscopic;
        self.estimates_gyroscopic = other.estimates_gyroscopic;
        self.is_unbiased = other.is_unbiased;
        self
    }

    /// Brings mass, inertia, thrust and the effects' forces to the scale of the weighed mass; their ratios stay as they are.
    /// Where no torque is compared, the inertia is the file's and stays. Returns the factor.
    pub(super) fn bring_to_scale(&mut self, compares_torques: bool) -> f64 {
        let Some(weighed_kg) = self.weighed_kg else { return 1.0 };
        let factor = weighed_kg / self.vehicle.body.mass_kg;
        self.vehicle.body.mass_kg = weighed_kg;
        if compares_torques {
            self.vehicle.body.inertia_kg_m2 *= factor;
        }
        self.vehicle.propulsion = self.vehicle.propulsion.scaled(factor);
        for present in &mut self.effects {
            for slot in 0..present.values.len() {
                if present.parameter(slot).is_some_and(|parameter| follows_force(parameter.unit)) {
                    present.values[slot] *= factor;
                }
            }
        }
        factor
    }

    /// Whether an estimated effect satisfies `what`.
    #[must_use]
    pub fn estimates(&self, what: impl Fn(&EffectTerm) -> bool) -> bool {
        self.effects.iter().any(|term| !term.free.is_empty() && what(term))
    }

    /// Whether the curvature of the thrust law is estimated.
    #[must_use]
    pub fn estimates_bend(&self) -> bool {
        self.estimates(|term| term.signature.role.bends_thrust.is_some())
    }

    /// Whether an estimated effect replaces this nuisance, which models small sizes of the same effect.
    #[must_use]
    pub fn stands_for(&self, nuisance: Nuisance) -> bool {
        self.estimates(|term| (term.signature.role.stands_for)(term, nuisance))
    }

    /// The model with its effects, and `more` of them.
    ///
    /// # Errors
    /// [`PhysicsError`] where the vehicle is not physical or lacks what an effect needs.
    pub fn model(&self, more: &[EffectTerm]) -> Result<Model, PhysicsError> {
        let effects = self
            .effects
            .iter()
            .chain(more)
            .map(|present| ActiveEffect::new(present.effect(), &present.values))
            .collect::<Result<Vec<_>, _>>()?;
        // along a recording only force and torque are asked for; while the search continues, the inertia may
        // be what no body has
        let mut vehicle = self.vehicle.clone();
        vehicle.body.inertia_kg_m2 = positive(&vehicle.body.inertia_kg_m2);
        Model::new(&vehicle, effects)
    }

    /// The latency as effects, for simulations. A delay below zero, which is only an offset of the log's time stamps,
    /// gives no effect.
    #[must_use]
    pub fn latency_effects(&self) -> Vec<EffectTerm> {
        let ActuationLatency { delay_s, lag_s, uneven } = self.latency;
        let of = |kind: LatencyKind, values: Vec<f64>| {
            let signature = latency_signature(kind).filter(|_| values[0] > 0.0)?;
            Some(signature.term(&values, &[]))
        };
        let RotorLag { rising_s, falling_s } = self.latency.rotor_lag();
        let lags_s = if uneven == 0.0 { vec![lag_s] } else { vec![rising_s, falling_s] };
        [of(LatencyKind::Lag, lags_s), of(LatencyKind::Delay, vec![delay_s])].into_iter().flatten().collect()
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
