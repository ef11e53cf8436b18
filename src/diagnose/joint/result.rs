//! Rigid body and effects, identified together.

use super::finding::EffectFound;
use crate::diagnose::channels::CHANNELS;
use crate::diagnose::fit::Fitted;
use crate::diagnose::latency::LatencyFinding;
use crate::diagnose::torque_law::TorqueLaw;
use crate::estimate::{Finding, MethodResult, ThrustScale};
use crate::physics::ActiveEffect;
use crate::vehicle::Vehicle;

/// Rigid body and effects, identified together.
#[derive(Debug, Clone)]
pub struct JointEstimate {
    /// the rigid body alone, on the same rows; without any latency if a lag or delay was named
    pub before: Fitted,
    /// rigid body and effects; forces on the scale of the stated thrust
    pub after: Fitted,
    /// mass and inertia with the effects
    pub body: MethodResult,
    /// and without
    pub body_before: MethodResult,
    /// factor of the rotors' thrust over the stated one, if the mass was weighed
    pub scale: Option<ThrustScale>,
    /// the vehicle with the determined parameters
    pub vehicle: Vehicle,
    /// in the requested order
    pub effects: Vec<EffectFound>,
    /// for simulations: these, and the other effects of the vehicle file
    pub acting: Vec<ActiveEffect>,
    /// between command and rotor
    pub latency: LatencyFinding,
    /// whether the latency is among the named effects
    pub latency_named: bool,
    /// whether the inertia is physically possible
    pub physical: Physical,
    /// where the rotors' torque certainly does not go with their thrust
    pub torque_law: Option<TorqueLaw>,
}

impl JointEstimate {
    /// Root mean square of the residual of each channel, before and with the effects, N and N m; `None` if the
    /// recording does not give the channel.
    #[must_use]
    pub fn misfit(&self) -> [Option<(f64, f64)>; CHANNELS] {
        let factor = self.factor();
        std::array::from_fn(|channel| {
            let of = |fitted: &Fitted| fitted.weighted.sigma[channel] * factor;
            (of(&self.after) > 0.0).then(|| (of(&self.before), of(&self.after)))
        })
    }

    /// Factor on forces for the scale of a weighed mass.
    #[must_use]
    pub fn factor(&self) -> f64 {
        match self.scale.as_ref().map(|scale| &scale.factor) {
            Some(Finding::Determined { value, .. }) => *value,
            _ => 1.0,
        }
    }
}

/// Whether an inertia is physically possible: no principal moment exceeds the sum of the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physical {
    /// it is possible
    AsEstimated,
    /// it was replaced by the nearest possible one, within its error
    Moved,
    /// it is impossible by more than its error: left as estimated
    No,
}
