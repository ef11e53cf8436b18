//! The effects that a vehicle has in all flights, by what single flights have named.

use super::explanation::{Explanation, Verdict};
use super::signature::EffectTerm;

/// Whose a parameter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// the same in every flight
    Vehicle,
    /// of the day: load, battery, wind
    Flight,
}

/// Whether an effect may be compared from flight to flight at all.
fn is_comparable(term: &EffectTerm) -> bool {
    term.signature.role.moment.is_none() && !term.free.is_empty()
}

/// Whose an effect is.
pub(super) fn owner(term: &EffectTerm) -> Owner {
    let role = &term.signature.role;
    if role.of_the_day || role.of_the_loading || role.hangs_below { Owner::Flight } else { Owner::Vehicle }
}

/// Each effect of the vehicle that was named, once, along all axes that one of the explanations has; each rotor may have its own.
pub(super) fn of_the_vehicle(explanations: &[&Explanation]) -> Vec<EffectTerm> {
    let mut terms: Vec<EffectTerm> = Vec::new();
    for explanation in explanations.iter().filter(|one| one.verdict != Verdict::Unexplained) {
        let named = |term: &&EffectTerm| explanation.named.iter().any(|named| named.id == term.id());
        for term in explanation.search.after.base.effects.iter().filter(named) {
            if !is_comparable(term) || owner(term) != Owner::Vehicle {
                continue;
            }
            match terms.iter_mut().find(|known| is_same(known, term)) {
                Some(known) => known.free_amounts_of(term),
                None => terms.push(term.clone()),
            }
        }
    }
    terms
}

/// Whether an effect estimates along body z what another one has as its law there.
fn has_axial(present: &EffectTerm, other: &EffectTerm) -> bool {
    let is_whole = other.signature.role.axial_part_of.is_some_and(|whole| whole.id() == present.id());
    is_whole && present.signature.role.axial.is_some_and(|slot| present.free.contains(&slot))
}

/// Whether an effect estimates as its own what a term estimates along body z.
fn is_part(part: &EffectTerm, term: &EffectTerm) -> bool {
    let role = &part.signature.role;
    let is_of = role.axial_part_of.is_some_and(|whole| whole.id() == term.id());
    let tells = |of: &EffectTerm| of.signature.role.axial.is_some_and(|slot| of.free.contains(&slot));
    is_of && tells(part) && tells(term)
}

/// Whether two terms are of one effect, and of one rotor where each may have its own.
pub(super) fn is_same(one: &EffectTerm, other: &EffectTerm) -> bool {
    let which = one.signature.role.which;
    one.id() == other.id() && which.is_none_or(|slot| one.values[slot] == other.values[slot])
}

/// Adds an effect of the vehicle to those of a flight. Where the flight has it along some axes only, it gets the others: what is left out of
/// one effect would go into another one that acts alike. Along body z all flights have one law: a part that has another one goes.
pub(super) fn add_term(effects: &mut Vec<EffectTerm>, term: &EffectTerm, can_show: impl Fn() -> bool) {
    match effects.iter().position(|present| is_same(present, term)) {
        Some(place) => effects[place].free_amounts_of(term),
        None if effects.iter().any(|present| has_axial(present, term)) || !can_show() => return,
        None => effects.push(term.clone()),
    }
    effects.retain(|present| !is_part(present, term));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::signatures::signature_of;

    fn term(id: &str, values: &[f64], free: &[usize]) -> EffectTerm {
        signature_of(id).unwrap().term(values, free)
    }

    #[test]
    fn a_flight_has_an_effect_along_all_axes_that_one_of_the_flights_has() {
        let of_vehicle = term("linear_drag", &[1.0, 1.1, 1.2, 0.0], &[0, 1, 2]);
        let quadratic = term("quadratic_drag", &[0.1, 0.1, 0.3, 0.0], &[0, 1, 2]);
        // a quadratic drag would take what a linear one along z leaves
        let mut own = vec![term("linear_drag", &[0.9, 0.9, 0.0, 0.2], &[0, 1, 3]), quadratic];
        add_term(&mut own, &of_vehicle, || true);
        assert_eq!(own.len(), 2);
        assert_eq!(
            (own[0].free.as_slice(), own[0].values.as_slice()),
            (&[0, 1, 2, 3][..], &[0.9, 0.9, 1.2, 0.2][..])
        );
        // what has another name along z has another law there
        let inflow = term("inflow", &[0.6, 0.0], &[0]);
        for mut own in
            [vec![inflow.clone()], vec![term("linear_drag", &[0.9, 0.9, 0.0, 0.0], &[0, 1]), inflow.clone()]]
        {
            add_term(&mut own, &of_vehicle, || true);
            assert_eq!((own.len(), own[0].id(), own[0].free.as_slice()), (1, "linear_drag", &[0, 1, 2][..]));
            add_term(&mut own, &inflow, || true);
            assert_eq!(own.len(), 1);
        }
        let across = term("linear_drag", &[1.0, 1.1, 0.0, 0.0], &[0, 1]);
        let mut own = vec![inflow];
        add_term(&mut own, &across, || true);
        assert_eq!(own.len(), 2);
        // and what the log cannot show is not added
        let mut none = Vec::new();
        add_term(&mut none, &of_vehicle, || false);
        assert!(none.is_empty());
    }
}
