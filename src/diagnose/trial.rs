//! Every candidate about a fitted base: its columns, and the evidence for it.

use super::base::{Base, Present};
use super::candidates::{Candidate, drag_and_wind};
use super::channels::Channels;
use super::fit::Fitted;
use super::tested::Tested;
use super::trace::Trace;
use rayon::prelude::*;

/// Candidates that the base does not have yet, wind with its drag among them.
pub(super) fn test_all(flights: &[Trace], fitted: &Fitted, candidates: &[Candidate]) -> Vec<Tested> {
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
    let columns: Vec<Option<Vec<Channels>>> =
        widest.par_iter().map(|candidate| columns_of(flights, fitted, candidate)).collect();
    let mut out: Vec<Tested> = open
        .par_iter()
        .filter_map(|candidate| {
            let (wide, columns) = widest.iter().zip(&columns).find(|(wide, _)| covers(wide, candidate))?;
            let evidence = fitted.weighted.test(&chosen(columns.as_ref()?, wide, candidate))?;
            Some(Tested { candidate: (*candidate).clone(), evidence })
        })
        .collect();
    out.extend([1.0, 0.0].into_iter().filter_map(|at_hubs| test_drag_and_wind(flights, fitted, at_hubs)));
    out
}

/// Every column of `candidate` is one of `wide`, too.
fn covers(wide: &Candidate, candidate: &Candidate) -> bool {
    wide.parts.len() == candidate.parts.len()
        && wide.parts.iter().zip(&candidate.parts).all(|(wide, part)| {
            wide.effect.id() == part.effect.id()
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

/// Columns of a candidate's free parameters; `None` where the vehicle lacks what it needs.
pub(super) fn columns_of(flights: &[Trace], fitted: &Fitted, candidate: &Candidate) -> Option<Vec<Channels>> {
    let mut columns = Vec::new();
    for part in &candidate.parts {
        columns.extend(fitted.rows.columns_of(flights, &fitted.base, part).ok()?);
    }
    Some(columns)
}

/// The same effect, for rotors the same rotor.
pub(super) fn is_present(base: &Base, candidate: &Candidate) -> bool {
    candidate.parts.iter().all(|part| {
        base.present.iter().any(|present| {
            present.effect.id() == part.effect.id()
                && (part.effect.id() != "weak_rotor" || present.values[0] == part.values[0])
                || drags_along_z(present) && drags_along_z(part)
        })
    })
}

/// Inflow and the z of drag are one term.
fn drags_along_z(present: &Present) -> bool {
    match present.effect.id() {
        "inflow" => true,
        "linear_drag" => present.free.contains(&2),
        _ => false,
    }
}

/// Wind acts through drag: both together, or wind alone where drag is known already.
fn test_drag_and_wind(flights: &[Trace], fitted: &Fitted, at_hubs: f64) -> Option<Tested> {
    let (drag, wind, unit) = drag_and_wind(at_hubs)?;
    let known = |id: &str| fitted.base.present.iter().any(|present| present.effect.id() == id);
    if known("steady_wind") || !flights.iter().all(|trace| trace.known.velocity && trace.known.attitude) {
        return None;
    }
    if known("linear_drag") || known("quadratic_drag") {
        if at_hubs < 1.0 {
            return None; // its columns come through the drag that is there
        }
        let candidate = Candidate { id: "steady_wind", parts: vec![wind], through: None };
        let columns = columns_of(flights, fitted, &candidate)?;
        let evidence = fitted.weighted.test(&columns)?;
        return Some(Tested { candidate, evidence });
    }
    let mut with_unit = fitted.base.clone();
    with_unit.present.push(unit.clone());
    let mut columns = fitted.rows.columns_of(flights, &fitted.base, &drag).ok()?;
    columns.extend(fitted.rows.columns_through(flights, &with_unit, &wind).ok()?);
    let evidence = fitted.weighted.test(&columns)?;
    // wind is named only for what it adds to drag
    let more = fitted.weighted.conditional(&columns, 2)?;
    let candidate = Candidate { id: "steady_wind", parts: vec![drag, wind], through: Some(unit) };
    (more > 4.0).then_some(Tested { candidate, evidence })
}
