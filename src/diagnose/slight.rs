//! Separates the effects that get a name from the traces, which are significant but immaterial.

use super::channels::Nuisance;
use super::fit::Fitted;
use super::floors::of_law;
use super::gates::NAME_Z;
use super::materiality::Materiality;
use super::named::{Named, NamedParameter};
use super::signature::EffectTerm;
use nalgebra::DVector;
use std::ops::Range;

/// An effect that is certain, and too small to matter: it has no name.
#[derive(Debug, Clone, PartialEq)]
pub struct Slight {
    /// which, with its values
    pub effect: Named,
    /// how little it is; `None` of gusts, which have no part of their own in the model
    pub materiality: Option<Materiality>,
}

/// An effect of a fit.
pub(super) struct FoundEffect {
    pub(super) effect: Named,
    /// among the effects of the base
    pub(super) place: usize,
    /// of its free values
    pub(super) columns: Range<usize>,
}

/// Standard errors by which a size must be beyond what is ordinary: 97.5 % of one side.
pub(super) const BEYOND: f64 = 2.0;

/// Those that matter, and the others. What is one effect to a reader is judged as one; and where what each of several can take over
/// of the others matters together, the greatest of them is named. `by_path`: the reconstructed
/// flight path told the laws of the drag.
pub(super) fn named_and_slight(
    (fitted, by_other_law): (&Fitted, &[f64]),
    candidates: Vec<FoundEffect>,
    by_path: bool,
) -> (Vec<Named>, Vec<Slight>) {
    let is_certain = |term: &EffectTerm, first: usize| is_certain((fitted, by_other_law), term, first);
    let term = |of: &FoundEffect| &fitted.base.effects[of.place];
    let together = |those: &[&FoundEffect]| {
        let each: Vec<_> = those.iter().map(|of| (term(of), of.columns.clone())).collect();
        Materiality::of(fitted, &each)
    };
    let is_one = |a: &FoundEffect, b: &FoundEffect| {
        let part = |part: &FoundEffect, whole: &FoundEffect| {
            term(part).signature.role.axial_part_of.is_some_and(|of| of.id() == term(whole).id())
        };
        part(a, b) || part(b, a)
    };
    let alone: Vec<Option<Materiality>> = candidates
        .iter()
        .map(|of| {
            let one: Vec<&FoundEffect> =
                candidates.iter().filter(|other| other.place == of.place || is_one(of, other)).collect();
            together(&one)
        })
        .collect();
    let mut matters: Vec<bool> = candidates
        .iter()
        .zip(&alone)
        .map(|(of, materiality)| {
            is_certain(term(of), of.columns.start) && is_material((fitted, by_path), of, *materiality)
        })
        .collect();
    loop {
        let left = |(index, of): &(usize, &FoundEffect)| {
            !matters[*index]
                && !term(of).is_of_sensors()
                && !term(of).is_of_every_vehicle(&fitted.base.size)
                && is_certain(term(of), of.columns.start)
        };
        let left: Vec<(usize, &FoundEffect)> = candidates.iter().enumerate().filter(left).collect();
        let those: Vec<&FoundEffect> = left.iter().map(|(_, of)| *of).collect();
        let misfit = |index: usize| alone[index].map_or(0.0, |of| of.misfit);
        let greatest =
            left.iter().max_by(|a, b| misfit(a.0).total_cmp(&misfit(b.0))).map(|(index, _)| *index);
        match greatest.filter(|_| those.len() > 1 && together(&those).is_some_and(|of| of.matters())) {
            Some(index) => matters[index] = true,
            None => break,
        }
    }
    let (mut named, mut slight) = (Vec::new(), Vec::new());
    for ((of, materiality), matters) in candidates.into_iter().zip(alone).zip(matters) {
        if matters {
            named.push(of.effect);
        } else {
            slight.push(Slight { effect: of.effect, materiality });
        }
    }
    (named, slight)
}

/// Whether the errors of an effect of several amounts leave a size: one of them, or the norm of all, is [`NAME_Z`] standard errors from
/// nothing. It was taken for the deviate of its score, which amounts may have made that are not told beside each other; of a single amount the
/// score is its own. Errors of laws and of guesses are shares of an amount, and say nothing against it, nor does what another law of a drag
/// brings into it across the rotor axis (`by_other_law`, variances of the effects' free values): it says which law, not whether there is a
/// drag. An amount that is next to nothing beside usual ones is none. Its first free value has the column `first`.
fn is_certain((fitted, by_other_law): (&Fitted, &[f64]), term: &EffectTerm, first: usize) -> bool {
    let amounts = || term.free.iter().enumerate().filter(|(_, slot)| term.is_amount(**slot));
    let counts = |slot: usize| {
        let usual =
            term.parameter(slot).and_then(|of| (term.signature.naming.usual)(of.name, &fitted.base.vehicle));
        usual.is_none_or(|usual| term.from_nothing(slot).abs() >= LEAST_OF_USUAL * usual)
    };
    let told: Vec<(f64, f64)> = amounts()
        .filter(|(_, slot)| counts(**slot))
        .map(|(index, &slot)| {
            let column = first + index;
            let place = column - fitted.rows.nuisances.len();
            // a force along the rotor axis, told by one law alone, may come from the rotors
            let is_across = term.signature.role.vertical != Some(slot);
            let of_other = by_other_law.get(place).copied().filter(|_| is_across).unwrap_or(0.0);
            let by_law = of_law(fitted, term, (slot, column)).powi(2) + of_other;
            let variance = (fitted.covariance[(column, column)] - by_law).max(0.0);
            (term.from_nothing(slot), variance.sqrt())
        })
        .collect();
    amounts().count() < 2 || differs_from_nothing(&told)
}

/// Share of its usual size below which an amount is next to nothing. Set by judgement.
const LEAST_OF_USUAL: f64 = 0.02;

/// Whether any of these, each with its standard error, or the norm of all is [`NAME_Z`] standard errors from zero.
fn differs_from_nothing(amounts: &[(f64, f64)]) -> bool {
    let norm = |of: fn(&(f64, f64)) -> f64| amounts.iter().map(|each| of(each).powi(2)).sum::<f64>().sqrt();
    // the error of the norm is that along itself
    let (size, along) = (norm(|(from, _)| *from), norm(|(from, std)| from * std));
    size > 0.0 && size * size >= NAME_Z * along
        || amounts.iter().any(|(from, std)| from.abs() >= NAME_Z * std)
}

/// An effect of the fit that would matter and is not certain.
pub(super) fn untold(fitted: &Fitted, by_other_law: &[f64]) -> Option<&'static str> {
    let mut first = fitted.rows.nuisances.len();
    for term in &fitted.base.effects {
        let columns = first..first + term.free.len();
        let is_certain = is_certain((fitted, by_other_law), term, first);
        first = columns.end;
        if !is_certain && Materiality::of(fitted, &[(term, columns)]).is_none_or(|of| of.matters()) {
            return Some(term.id());
        }
    }
    None
}

/// Parameters of an effect as they are stated, with their standard errors; its first free value has the column `first`.
pub(super) fn stated(fitted: &Fitted, term: &EffectTerm, first: usize) -> Vec<NamedParameter> {
    let of_slot = |slot: usize| {
        let parameter = term.parameter(slot)?;
        let (value, column) = (term.values[slot], term.free.iter().position(|free| *free == slot));
        let std = column.map_or(0.0, |column| fitted.std_of(first + column, (value, parameter.unit)));
        let is_free = column.is_some();
        let least = if is_free && term.is_amount(slot) { term.signature.naming.least_std } else { 0.0 };
        let is_shown = fitted.rows.compares_torques || !term.is_share_at_hubs(slot);
        (is_shown && (is_free || (term.signature.naming.says)(term, slot))).then(|| NamedParameter {
            name: parameter.name,
            value,
            std: std.hypot(least),
            unit: parameter.unit,
        })
    };
    (0..term.values.len()).filter_map(of_slot).collect()
}

/// Whether an effect matters by itself. One whose own part is not known (`None`) does. A law of the drag beside another one need not show in
/// the misfit where the flight path tells it (`by_path`): there the error of the autopilot's velocity hides nothing.
fn is_material((fitted, by_path): (&Fitted, bool), of: &FoundEffect, own: Option<Materiality>) -> bool {
    let term = &fitted.base.effects[of.place];
    if term.is_of_every_vehicle(&fitted.base.size) {
        return false;
    }
    // what it stands for is an error of the sensors that every vehicle has
    let stands_for_offset = (term.signature.role.stands_for)(term, Nuisance::Tilt(0));
    if stands_for_offset && !is_beyond_ordinary(fitted, term, of.columns.start) {
        return false;
    }
    if term.is_of_sensors() {
        is_beyond_ordinary(fitted, term, of.columns.start) && own.is_none_or(|of| of.shows())
    } else {
        let beside_another = |other: &EffectTerm| other.signature.is_drag() && !other.is(term.signature);
        let is_told = by_path && term.signature.is_drag() && fitted.base.effects.iter().any(beside_another);
        own.is_none_or(|of| of.matters() || is_told && of.is_more_than_noise())
    }
}

/// Whether its size is certainly beyond what is ordinary; its first free value has the column `first`.
fn is_beyond_ordinary(fitted: &Fitted, term: &EffectTerm, first: usize) -> bool {
    let Some(ordinary) = term.signature.naming.ordinary else { return true };
    let size = term.size();
    let along = |slot: usize| if term.is_amount(slot) { term.values[slot] / size } else { 0.0 };
    let unit = DVector::from_iterator(term.free.len(), term.free.iter().map(|&slot| along(slot)));
    let count = term.free.len();
    let variance = unit.dot(&(fitted.covariance.view((first, first), (count, count)) * &unit));
    size - BEYOND * variance.max(0.0).sqrt() > ordinary
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_its_own_errors_do_not_tell_from_nothing_is_not_certain() {
        assert!(!differs_from_nothing(&[(0.0055, 0.0019), (0.0046, 0.0077), (0.123, 0.11)]));
        // one of its amounts is enough
        assert!(differs_from_nothing(&[(0.174, 0.031), (0.197, 0.086), (0.104, 0.09)]));
        // a wind between two axes
        assert!(differs_from_nothing(&[(1.0, 0.3), (1.0, 0.3)]));
        assert!(!differs_from_nothing(&[(1.0, 0.4), (1.0, 0.4)]));
    }
}
