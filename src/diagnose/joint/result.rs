//! Rigid body and effects, identified together.

use super::finding::EffectFound;
use crate::diagnose::channels::CHANNELS;
use crate::diagnose::fit::Fitted;
use crate::diagnose::latency::LatencyFinding;
use crate::estimate::{Finding, MethodResult, ThrustScale};
use crate::physics::ActiveEffect;
use crate::vehicle::Vehicle;

/// Rigid body and effects, identified together.
#[derive(Debug, Clone)]
pub struct JointEstimate {
    /// the rigid body alone, on the same rows; where a lag or delay was named, without any latency
    pub before: Fitted,
    /// rigid body and effects; forces on the scale of the stated thrust
    pub after: Fitted,
    /// mass and inertia with the effects
    pub body: MethodResult,
    /// and without
    pub body_before: MethodResult,
    /// how much stronger the rotors are than stated, where the mass was weighed
    pub scale: Option<ThrustScale>,
    /// the vehicle with what was determined
    pub vehicle: Vehicle,
    /// in the order in which they were asked for
    pub effects: Vec<EffectFound>,
    /// for simulations: those, and what the vehicle's file had beside them
    pub acting: Vec<ActiveEffect>,
    /// between command and rotor
    pub latency: LatencyFinding,
    /// it is among the named effects
    pub latency_named: bool,
    /// whether the inertia is one that a body can have
    pub physical: Physical,
}

impl JointEstimate {
    /// Root mean square of what is left in each channel, before and with the effects, N and N m; `None` where
    /// the recording does not give the channel.
    #[must_use]
    pub fn misfit(&self) -> [Option<(f64, f64)>; CHANNELS] {
        let factor = self.factor();
        std::array::from_fn(|channel| {
            let of = |fitted: &Fitted| fitted.weighted.sigma[channel] * factor;
            (of(&self.after) > 0.0).then(|| (of(&self.before), of(&self.after)))
        })
    }

    /// What forces are multiplied by for the scale of a weighed mass.
    #[must_use]
    pub fn factor(&self) -> f64 {
        match self.scale.as_ref().map(|scale| &scale.factor) {
            Some(Finding::Determined { value, .. }) => *value,
            _ => 1.0,
        }
    }
}

/// An inertia that a body can have: no principal moment exceeds the sum of the others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physical {
    /// it is one
    AsEstimated,
    /// it was moved to the nearest that is, within its error
    Moved,
    /// it is not, by more than its error: left as estimated
    No,
}
