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
    /// of the parameter's value
    share: f64,
    /// in the parameter's unit
    amount: f64,
}

impl Relevance {
    pub(super) const fn share(share: f64) -> Option<Self> {
        Some(Self { share, amount: 0.0 })
    }

    /// Of a value of an effect.
    pub(super) fn of(term: &EffectTerm, slot: usize) -> Option<Self> {
        let of = term.signature.role.of_the_vehicle.filter(|of| of.slots.contains(&slot))?;
        Some(Self { share: AMOUNT_SHARE, amount: of.least_difference })
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
        let Some(Relevance { share, amount }) = self.relevance else { return false };
        // a small value moves by much of itself
        let moved = (self.held_out - self.identified).abs() > amount;
        self.sigmas().abs() > SIGMAS && self.share().abs() > share && moved
    }
}

/// Largest share of the mass that a payload is, with which a multirotor still flies well.
pub(super) const PAYLOAD_SHARE: f64 = 0.5;
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
