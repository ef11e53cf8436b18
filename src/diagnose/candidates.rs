//! Candidates: each effect at the values at which it has no influence.

use super::recorded::Recorded;
use super::signature::{EffectTerm, Form, Signature};
use super::trace::Trace;
use crate::vehicle::Vehicle;

/// One or more effects that are tested together.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// identifier of the effect that the evidence is about
    pub id: &'static str,
    /// with the values at which they have no influence
    pub parts: Vec<EffectTerm>,
    /// the columns act through another effect at this value, as wind acts through drag
    pub through: Option<EffectTerm>,
}

impl Candidate {
    /// A candidate of one effect.
    #[must_use]
    pub fn alone(term: EffectTerm) -> Self {
        Self { id: term.id(), parts: vec![term], through: None }
    }

    /// The signature of the effect that the evidence is about, the last of several.
    #[must_use]
    pub fn signature(&self) -> Option<&'static Signature> {
        self.parts.last().map(|part| part.signature)
    }
}

/// All candidates that the vehicle file and the recordings allow, without those that act through other effects and
/// those that a nuisance models.
#[must_use]
pub fn candidates(vehicle: &Vehicle, flights: &[Trace], signatures: &[&'static Signature]) -> Vec<Candidate> {
    forms((vehicle, flights), signatures, false)
}

/// The candidates that a nuisance models.
#[must_use]
pub(super) fn instead_of_nuisances(
    vehicle: &Vehicle,
    flights: &[Trace],
    signatures: &[&'static Signature],
) -> Vec<Candidate> {
    forms((vehicle, flights), signatures, true)
}

fn forms(
    (vehicle, flights): (&Vehicle, &[Trace]),
    signatures: &[&'static Signature],
    instead_of_nuisance: bool,
) -> Vec<Candidate> {
    let recorded = Recorded::new(vehicle, flights);
    let possible = signatures.iter().filter(|signature| recorded.lacks(signature.needs).is_none());
    let forms = possible.flat_map(|signature| (signature.forms)(&recorded));
    let of_turn = forms.filter(|form: &Form| form.instead_of_nuisance == instead_of_nuisance);
    of_turn.map(|form| Candidate::alone(form.term)).collect()
}
