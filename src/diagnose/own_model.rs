//! The model of one of several flights: that of the vehicle with what is the flight's own.

use super::base::Base;
use super::signature::EffectTerm;
use super::signatures::ALL;
use super::trace::Trace;
use crate::physics::{Model, PhysicsError};
use crate::signals::OwnOfFlight;
use std::borrow::Cow;
use std::sync::Arc;

impl Base {
    /// The same on a flight: with its payload, without the effects that this flight has not, and with those that it alone has. Effects of the
    /// vehicle keep their places.
    pub(super) fn on(&self, own: &OwnOfFlight) -> Cow<'_, Self> {
        let lacks_none = self.effects.iter().all(|term| !term.is_lacking(own));
        if own.payload_kg == 0.0 && own.has.is_empty() && lacks_none {
            return Cow::Borrowed(self);
        }
        let mut base = self.clone();
        base.vehicle.body.mass_kg += own.payload_kg;
        base.effects.iter_mut().filter(|term| term.is_lacking(own)).for_each(EffectTerm::vanish);
        base.effects.extend(own.has.iter().filter_map(|(id, values)| {
            let signature = ALL.iter().find(|signature| signature.id() == *id)?;
            Some(signature.term(values, &[]))
        }));
        Cow::Owned(base)
    }

    /// Its model on each of these flights.
    pub(super) fn models(&self, flights: &[Trace]) -> Result<Vec<Arc<Model>>, PhysicsError> {
        let mut common: Option<Arc<Model>> = None;
        let one = |trace: &Trace| match (self.on(&trace.own), &common) {
            (Cow::Borrowed(_), Some(common)) => Ok(Arc::clone(common)),
            (Cow::Borrowed(base), None) => Ok(Arc::clone(common.insert(Arc::new(base.model(&[])?)))),
            (Cow::Owned(mut base), _) => {
                // first what the models have in common
                base.effects.rotate_right(trace.own.has.len());
                Ok(Arc::new(base.model(&[])?))
            }
        };
        flights.iter().map(one).collect()
    }
}

impl Trace {
    /// The same flight with something else its own.
    pub(super) fn with_own(&self, own: OwnOfFlight) -> Self {
        let mut trace = self.clone();
        trace.own = own;
        trace
    }
}

impl EffectTerm {
    fn is_lacking(&self, own: &OwnOfFlight) -> bool {
        let which = self.signature.role.which.map(|slot| self.values[slot]);
        own.lacks
            .iter()
            .any(|lacking| lacking.effect == self.id() && (lacking.which.is_none() || lacking.which == which))
    }

    /// At the values at which it does nothing.
    fn vanish(&mut self) {
        for &amount in self.signature.amounts {
            self.values[amount] = self.signature.nothing;
        }
        for slot in self.free.clone() {
            self.values[slot] = self.nothing_at(slot);
        }
    }
}
