//! Every candidate at a fitted base: its columns and its evidence.

use super::base::Base;
use super::candidates::Candidate;
use super::channels::Channels;
use super::fit::Fitted;
use super::signature::{Carried, EffectTerm, Signature};
use super::tested::Tested;
use super::trace::Trace;
use rayon::prelude::*;

/// Tests the candidates that the base does not have yet, and wind together with its drag.
pub(super) fn test_all(
    flights: &[Trace],
    fitted: &Fitted,
    candidates: &[Candidate],
    signatures: &[&'static Signature],
) -> Vec<Tested> {
    let open: Vec<&Candidate> =
        candidates.iter().filter(|candidate| !is_present(&fitted.base, candidate)).collect();
    // the same effect with fewer parameters has some of the columns
    let widest: Vec<&Candidate> = open
        .iter()
        .enumerate()
        .filter(|(place, candidate)| {
            let wider = |(other, wide): (usize, &&Candidate)| {
                other != *place && covers(wide, candidate) && !(other > *place && covers(candidate, wide))
            };
            !open.iter().enumerate().any(wider)
        })
        .map(|(_, candidate)| *candidate)
        .collect();
    let tested_of = |(place, columns): (usize, Option<Vec<Channels>>)| -> Vec<(usize, Tested)> {
        let (wide, Some(columns)) = (widest[place], columns) else { return Vec::new() };
        let is_of =
            |candidate: &Candidate| widest.iter().position(|wide| covers(wide, candidate)) == Some(place);
        let covered = open.iter().enumerate().filter(|(_, candidate)| is_of(candidate));
        let tested = covered.filter_map(|(index, candidate)| {
            let evidence = fitted.weighted.test(&chosen(&columns, wide, candidate))?;
            Some((index, Tested { candidate: (*candidate).clone(), evidence }))
        });
        tested.collect()
    };
    // columns of a long flight take much memory: those of some candidates are gone before the next ones'
    let some = at_once(fitted);
    let mut tested: Vec<(usize, Tested)> = widest
        .par_chunks(some)
        .enumerate()
        .flat_map_iter(|(chunk, wide)| {
            let columns = columns_of_each(flights, fitted, wide);
            (chunk * some..).zip(columns).flat_map(tested_of).collect::<Vec<_>>()
        })
        .collect();
    tested.sort_by_key(|(index, _)| *index);
    let mut out: Vec<Tested> = tested.into_iter().map(|(_, tested)| tested).collect();
    out.extend(test_winds(flights, fitted, signatures));
    // in the order of the signatures
    let place =
        |tested: &Tested| signatures.iter().position(|signature| signature.id() == tested.candidate.id);
    out.sort_by_key(place);
    out
}

/// Whether every column of `candidate` is also one of `wide`.
fn covers(wide: &Candidate, candidate: &Candidate) -> bool {
    wide.parts.len() == candidate.parts.len()
        && wide.parts.iter().zip(&candidate.parts).all(|(wide, part)| {
            wide.is(part.signature)
                && wide.values == part.values
                && part.free.iter().all(|slot| wide.free.contains(slot))
        })
}

/// The columns of `wide` that `candidate` has.
fn chosen(columns: &[Channels], wide: &Candidate, candidate: &Candidate) -> Vec<Channels> {
    let mut of_wide = columns.iter();
    let mut out = Vec::new();
    for (wide, part) in wide.parts.iter().zip(&candidate.parts) {
        let own: Vec<(&usize, &Channels)> = wide.free.iter().zip(of_wide.by_ref()).collect();
        let of_slot = |slot: &usize| own.iter().find(|(free, _)| *free == slot);
        out.extend(part.free.iter().filter_map(of_slot).map(|(_, column)| (*column).clone()));
    }
    out
}

/// Candidates of which the columns are computed together.
pub(super) fn at_once(fitted: &Fitted) -> usize {
    (ROWS_AT_ONCE / fitted.rows.len().max(1)).clamp(1, 16)
}

/// Rows times candidates that are held at a time.
const ROWS_AT_ONCE: usize = 1 << 15;

/// Columns of a candidate's free parameters; `None` if the vehicle file lacks a value that it needs.
pub(super) fn columns_of(flights: &[Trace], fitted: &Fitted, candidate: &Candidate) -> Option<Vec<Channels>> {
    columns_of_each(flights, fitted, &[candidate]).pop()?
}

/// The same of several candidates.
pub(super) fn columns_of_each(
    flights: &[Trace],
    fitted: &Fitted,
    candidates: &[&Candidate],
) -> Vec<Option<Vec<Channels>>> {
    let parts: Vec<&EffectTerm> = candidates.iter().flat_map(|candidate| &candidate.parts).collect();
    let mut columns = fitted.rows.columns_of_each(flights, &fitted.base, &parts).into_iter();
    let of = |candidate: &&Candidate| {
        let own: Vec<_> = columns.by_ref().take(candidate.parts.len()).collect();
        let own: Vec<Vec<Channels>> = own.into_iter().collect::<Result<_, _>>().ok()?;
        Some(own.into_iter().flatten().collect())
    };
    candidates.iter().map(of).collect()
}

/// The same effect, for rotors the same rotor.
pub(super) fn is_present(base: &Base, candidate: &Candidate) -> bool {
    candidate.parts.iter().all(|part| {
        base.effects.iter().any(|present| {
            present.is(part.signature) && is_the_same(present, part)
                || drags_along_z(present) && drags_along_z(part)
        })
    })
}

/// Whether it is the same instance of an effect with several instances (rotors).
fn is_the_same(present: &EffectTerm, part: &EffectTerm) -> bool {
    part.signature.role.which.is_none_or(|slot| present.values[slot] == part.values[slot])
}

/// Whether a term has drag along body z. Inflow and the z component of drag are the same term.
fn drags_along_z(term: &EffectTerm) -> bool {
    term.signature.role.axial.is_some_and(|slot| term.free.contains(&slot))
}

/// Tests wind. It acts through drag: both are tested together, or the wind alone if a drag is in the base.
pub(super) fn test_winds(
    flights: &[Trace],
    fitted: &Fitted,
    signatures: &[&'static Signature],
) -> Vec<Tested> {
    let present = &fitted.base.effects;
    let is_wind = |term: &EffectTerm| term.signature.role.wind.is_some();
    let moving = flights.iter().all(|trace| trace.known.velocity && trace.known.attitude);
    if present.iter().any(is_wind) || !moving {
        return Vec::new();
    }
    let carried = signatures.iter().filter_map(|signature| signature.role.wind).flat_map(|carried| carried());
    if present.iter().any(|term| term.signature.is_drag()) {
        // its columns come through the drag that is there
        let alone = carried.take(1).filter_map(|wind| {
            let candidate = Candidate::alone(wind.term);
            let evidence = fitted.weighted.test(&columns_of(flights, fitted, &candidate)?)?;
            Some(Tested { candidate, evidence })
        });
        return alone.collect();
    }
    carried.filter_map(|wind| test_carried(flights, fitted, wind)).collect()
}

/// Tests an effect together with the one through which it acts.
fn test_carried(flights: &[Trace], fitted: &Fitted, carried: Carried) -> Option<Tested> {
    let Carried { carrier, unit, term } = carried;
    let mut with_unit = fitted.base.clone();
    with_unit.effects.push(unit.clone());
    let mut columns = fitted.rows.columns_of(flights, &fitted.base, &carrier).ok()?;
    columns.extend(fitted.rows.columns_through(flights, &with_unit, &term).ok()?);
    let evidence = fitted.weighted.test(&columns)?;
    // it is named only for what it adds to its carrier
    let more = fitted.weighted.conditional(&columns, carrier.free.len())?;
    let candidate = Candidate { id: term.id(), parts: vec![carrier, term], through: Some(unit) };
    (more > 4.0).then_some(Tested { candidate, evidence })
}
