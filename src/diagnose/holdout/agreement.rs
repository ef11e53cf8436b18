//! A parameter's value on held-out flights against that of a model.

use crate::diagnose::signature::EffectTerm;
use crate::estimate::NAMES;

/// A parameter's value on the held-out flights against that of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// `mass`, `ixx` ... or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// of the model
    pub identified: f64,
    /// its standard error
    pub identified_std: f64,
    /// of the held-out flights alone
    pub held_out: f64,
    /// its standard error
    pub held_out_std: f64,
    /// the least difference that counts; `None` for a parameter that flights of one vehicle need not have in common
    pub(super) relevance: Option<Relevance>,
}

/// The least difference of a parameter that counts: it has to exceed both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Relevance {
    /// of the parameter's value, counted from where the effect is none
    share: f64,
    /// value at which the effect is none
    nothing: f64,
    /// in the parameter's unit
    amount: f64,
}

impl Relevance {
    pub(super) const fn share(share: f64) -> Option<Self> {
        Some(Self { share, nothing: 0.0, amount: 0.0 })
    }

    /// Of an amount, which is none at zero.
    pub(super) fn is_of_an_amount(&self) -> bool {
        self.nothing == 0.0
    }

    /// Of a value of an effect.
    pub(super) fn of(term: &EffectTerm, slot: usize) -> Option<Self> {
        let of = term.signature.role.of_the_vehicle.filter(|of| of.slots.contains(&slot))?;
        Some(Self { share: AMOUNT_SHARE, nothing: term.signature.nothing, amount: of.least_difference })
    }
}

impl Agreement {
    /// Difference in standard errors of the difference.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        (self.held_out - self.identified) / self.identified_std.hypot(self.held_out_std)
    }

    /// Difference as a share of the model's value.
    #[must_use]
    pub fn share(&self) -> f64 {
        (self.held_out - self.identified) / self.identified
    }

    /// A difference of mass alone that a payload makes.
    pub(super) fn is_by_a_load(&self) -> bool {
        self.name == NAMES[0] && self.share().abs() < PAYLOAD_SHARE
    }

    pub(super) fn is_of_inertia(&self) -> bool {
        NAMES[1..].contains(&self.name.as_str())
    }

    /// Whether they differ significantly, and by more than flights of one vehicle do.
    pub(super) fn differs(&self) -> bool {
        let Some(Relevance { share, nothing, amount }) = self.relevance else { return false };
        let by = (self.held_out - self.identified).abs();
        // a small value moves by much of itself
        self.sigmas().abs() > SIGMAS && by > share * (self.identified - nothing).abs() && by > amount
    }
}

/// Largest share of the mass that a payload is, with which a multirotor still flies well.
const PAYLOAD_SHARE: f64 = 0.5;
/// Standard errors beyond which flights certainly differ: twice what a name needs, because a false word takes the whole hold-out away.
const SIGMAS: f64 = 8.0;
/// Least relevant difference, as a share of the mass. Set by judgement: with less, two batteries would be two
/// vehicles.
pub(super) const MASS_SHARE: f64 = 0.08;
/// Least relevant difference, as a share of a principal moment of inertia. Set by judgement: the phase at which a log
/// samples moves inertia by up to 12 % (see `Spread` in `study/track.rs`), and twice that is no sampling.
pub(super) const INERTIA_SHARE: f64 = 0.22;
/// Least relevant difference of an effect that belongs to the vehicle, as a share of its amount. Set by judgement:
/// laws are never quite those of the air, and flights differ in speed.
const AMOUNT_SHARE: f64 = 0.6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::signatures::signature_of;

    /// Of a weak rotor that gives 0.846 by the model, on a hold-out where it gives this.
    fn of_a_rotor(held_out: f64) -> Agreement {
        let signature = signature_of("weak_rotor").expect("an effect");
        let term = signature.term(&[0.0, 0.846], &[1]);
        Agreement {
            name: "weak_rotor.factor".to_owned(),
            unit: "-",
            identified: 0.846,
            identified_std: 0.003,
            held_out,
            held_out_std: 0.003,
            relevance: Relevance::of(&term, 1),
        }
    }

    #[test]
    fn a_rotor_that_is_whole_on_the_hold_out_is_of_another_vehicle() {
        assert!(of_a_rotor(1.0).differs());
        // a sixth of the weakness, and one that is certain but small
        assert!(!of_a_rotor(0.87).differs());
        let small =
            Agreement { identified: 0.98, identified_std: 0.001, held_out_std: 0.001, ..of_a_rotor(1.0) };
        assert!(small.sigmas() > SIGMAS && !small.differs());
    }
}
