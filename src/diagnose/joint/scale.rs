//! The scale of force with a weighed mass. The fit has the scale of the stated thrust, and the effects of the vehicle
//! file that of the weighed mass.

use super::choose::Chosen;
use super::held::{FittedForm, estimate_forms};
use crate::diagnose::base::{Base, follows_force};
use crate::diagnose::fit::{Fitted, Newton};
use crate::diagnose::latency::{LatencyFinding, fit_latency};
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::trace::Trace;
use crate::physics::{ActiveEffect, PhysicsError};
use crate::vehicle::{Anchor, Vehicle};

/// Largest number of passes over the scale. A number of steps: only the time of a search and its last digits depend
/// on it.
const PASSES: usize = 4;
/// A scale that moves by less than this share has converged. Far below the least error of a mass.
const CONVERGED: f64 = 1e-4;

/// Effects of the vehicle file that act as stated.
pub(super) struct Kept<'a> {
    pub(super) vehicle: &'a Vehicle,
    pub(super) effects: &'a [&'a ActiveEffect],
}

impl Kept<'_> {
    /// The effects on the scale of the stated thrust, if the weighed mass is `factor` times the mass on that scale.
    /// Effects between command and rotor speed go through the latency.
    fn on_scale(&self, factor: f64) -> Vec<EffectTerm> {
        let one = |known: &&ActiveEffect| {
            let signature = signature_of(known.effect().id())?;
            let mut present = signature.term(known.parameters(), &[]);
            for slot in 0..present.values.len() {
                if present.parameter(slot).is_some_and(|parameter| follows_force(parameter.unit)) {
                    present.values[slot] /= factor;
                }
            }
            signature.role.latency.is_none().then_some(present)
        };
        self.effects.iter().filter_map(one).collect()
    }

    /// The factor of a fit; `None` if nothing depends on it.
    fn factor(&self, fitted: &Fitted) -> Option<f64> {
        let weighed = self.vehicle.anchor == Anchor::Mass && !self.effects.is_empty();
        weighed.then(|| self.vehicle.body.mass_kg / fitted.base.vehicle.body.mass_kg)
    }

    /// Fits the rigid body with these effects only, and its latency.
    pub(super) fn fit_latency(
        &self,
        flights: &[Trace],
    ) -> Result<(Base, Fitted, LatencyFinding), PhysicsError> {
        let mut factor = 1.0_f64;
        let mut pass = 0;
        loop {
            let base = Base { effects: self.on_scale(factor), ..Base::rigid(self.vehicle) };
            let (fitted, latency) = fit_latency(flights, base.clone())?;
            let base = base.turning_as(&fitted.base);
            pass += 1;
            match self.factor(&fitted) {
                Some(now) if (now / factor - 1.0).abs() > CONVERGED && pass < PASSES => factor = now,
                _ => return Ok((base, fitted, latency)),
            }
        }
    }

    /// [`estimate_forms`] on the scale that comes out of it; `base` holds them before all others.
    pub(super) fn estimate_forms(
        &self,
        flights: &[Trace],
        mut base: Base,
        chosen: &[Chosen],
        newton: Newton,
    ) -> Result<(Fitted, Vec<FittedForm>), PhysicsError> {
        let mut factor: Option<f64> = None;
        let mut pass = 0;
        loop {
            let settled = estimate_forms(flights, &base, chosen.to_vec(), newton)?;
            pass += 1;
            match self.factor(&settled.0) {
                Some(now)
                    if factor.is_none_or(|factor| (now / factor - 1.0).abs() > CONVERGED)
                        && pass < PASSES =>
                {
                    base.effects = self.on_scale(now);
                    factor = Some(now);
                }
                _ => return Ok(settled),
            }
        }
    }
}
