//! The model so far: rigid body, actuation latency, and the effects that were accepted.

use crate::physics::effects::by_id;
use crate::physics::{ActiveEffect, Effect, Model, PhysicsError};
use crate::signals::ActuationLatency;
use crate::vehicle::Vehicle;

/// An effect with its values, and which of them are estimated.
#[derive(Debug, Clone)]
pub struct Present {
    /// which
    pub effect: &'static dyn Effect,
    /// in the order of [`Effect::parameters`]
    pub values: Vec<f64>,
    /// indices of those that are estimated
    pub free: Vec<usize>,
}

impl Present {
    /// Value at which a parameter's effect vanishes.
    #[must_use]
    pub fn nothing_at(&self, slot: usize) -> f64 {
        if self.effect.id() == "weak_rotor" && slot == 1 { 1.0 } else { 0.0 }
    }
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
        Model::new(&self.vehicle, effects)
    }

    /// The latency as effects, for simulations; a delay below zero, which only the log's own stamps can
    /// make, is none.
    #[must_use]
    pub fn latency_effects(&self) -> Vec<Present> {
        let ActuationLatency { delay_s, lag_s } = self.latency;
        let of = |id: &str, value: f64| {
            let effect = by_id(id).filter(|_| value > 0.0)?;
            Some(Present { effect, values: vec![value], free: Vec::new() })
        };
        [of("motor_lag", lag_s), of("transport_delay", delay_s)].into_iter().flatten().collect()
    }
}
