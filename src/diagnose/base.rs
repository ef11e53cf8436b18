//! The model so far: rigid body, actuation latency, and the effects that were accepted.

use super::channels::Nuisance;
use super::signature::{EffectTerm, LatencyKind};
use super::signatures::latency_signature;
use crate::physics::{ActiveEffect, ActuationLatency, Model, PhysicsError, RotorLag};
use crate::vehicle::{Vehicle, VehicleSize};
use nalgebra::Matrix3;

/// A load to start from is no more than this share of the mass.
const MOST_OF_MASS: f64 = 0.5;

/// A load that was in the mass `all_kg` (kg) of a rigid body until now: returns the vehicle's own, kg. Its swing is that
/// of the measured motion, whatever the load.
pub(super) fn lift_load(load: &mut EffectTerm, all_kg: f64) -> f64 {
    load.values[0] = load.values[0].min(MOST_OF_MASS * all_kg);
    all_kg - load.values[0]
}

/// What the recording is compared with.
#[derive(Debug, Clone)]
pub struct Base {
    /// with mass and inertia as now estimated
    pub vehicle: Vehicle,
    /// as stated: what is plausible of an effect does not change while mass is estimated
    pub size: VehicleSize,
    /// between command and rotor
    pub latency: ActuationLatency,
    /// beside the rigid body
    pub present: Vec<EffectTerm>,
}

impl Base {
    /// A rigid body alone.
    #[must_use]
    pub fn rigid(vehicle: &Vehicle) -> Self {
        Self {
            vehicle: vehicle.clone(),
            size: vehicle.size(),
            latency: ActuationLatency::default(),
            present: Vec::new(),
        }
    }

    /// An effect for which this holds is estimated.
    #[must_use]
    pub fn estimates(&self, what: impl Fn(&EffectTerm) -> bool) -> bool {
        self.present.iter().any(|term| !term.free.is_empty() && what(term))
    }

    /// An effect that is estimated stands for what this nuisance is the small size of.
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
            .present
            .iter()
            .chain(more)
            .map(|present| ActiveEffect::new(present.effect(), &present.values))
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
