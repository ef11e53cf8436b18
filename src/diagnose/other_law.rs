//! What a drag of another law, which the flight does not show, may do to the sizes of the one that it shows.
//!
//! Within the speeds of one flight a drag in proportion to the airspeed and one with its square are nearly the same force. Where the
//! model has one of them, the other may be there as well, at the size that ordinary vehicles have, as far as the flight does not
//! exclude it. What it brings into the other sizes belongs to their standard errors (consider covariance).

use super::candidates::{Candidate, candidates};
use super::evidence::weighted;
use super::fit::Fitted;
use super::score::columns_of;
use super::signature::EffectTerm;
use super::signatures::ALL;
use super::tested::Tested;
use super::trace::Trace;
use nalgebra::{DMatrix, DVector};

/// Adds to the covariance of a fit's effects what the drag laws among the candidates that were not taken may bring into them.
pub(super) fn add_other_laws(flights: &[Trace], last: &[Tested], fitted: &mut Fitted) {
    fitted.covariance += of_other_laws(flights, last, fitted);
}

/// The drag laws that a fit does not have, tested on its flights.
pub(super) fn tested_laws(flights: &[Trace], fitted: &Fitted) -> Vec<Tested> {
    let all = candidates(&fitted.base.vehicle, flights, ALL).into_iter();
    let others = all.filter(|candidate| is_other_law(candidate, fitted));
    let tested = others.filter_map(|candidate| {
        let evidence = fitted.weighted.test(&columns_of(flights, fitted, &candidate)?)?;
        Some(Tested { candidate, evidence })
    });
    tested.collect()
}

fn drags(term: &EffectTerm) -> bool {
    term.signature.role.lateral_slope.is_some()
}

/// A drag alone, of a law that the fit does not have.
fn is_other_law(candidate: &Candidate, fitted: &Fitted) -> bool {
    let [part] = candidate.parts.as_slice() else { return false };
    let is_new = || fitted.base.effects.iter().all(|present| !present.is(part.signature));
    candidate.through.is_none() && drags(part) && is_new()
}

/// Covariance that the drag laws among the candidates that were not taken may bring into a fit's coefficients.
pub(super) fn of_other_laws(flights: &[Trace], last: &[Tested], fitted: &Fitted) -> DMatrix<f64> {
    let count = fitted.covariance.nrows();
    let mut most: DMatrix<f64> = DMatrix::zeros(count, count);
    if !fitted.base.effects.iter().any(drags) {
        return most;
    }
    // a drag along z is told from an inflow by the search
    let with_air = |term: &EffectTerm| drags(term) || term.signature.role.wind.is_some();
    let present = &fitted.base.effects;
    let go_along: Vec<bool> = present.iter().flat_map(|term| vec![with_air(term); term.free.len()]).collect();
    for tested in last.iter().filter(|tested| is_other_law(&tested.candidate, fitted)) {
        let [part] = tested.candidate.parts.as_slice() else { continue };
        let Ok(columns) = fitted.rows.columns_of(flights, &fitted.base, part) else { continue };
        let mut added = DMatrix::zeros(count, count);
        for (index, (column, &slot)) in columns.iter().zip(&part.free).enumerate() {
            let Some(parameter) = part.parameter(slot) else { continue };
            let usual = (part.signature.naming.usual)(parameter.name, &fitted.base.vehicle);
            let Some(usual) = usual else { continue };
            let (told, std) = (tested.evidence.theta[index], tested.evidence.std(index));
            let mut brings: DVector<f64> = fitted.weighted.part_in(&weighted(column, &fitted.weighted.sigma));
            let effects = brings.len() - go_along.len();
            for (place, brings) in brings.iter_mut().enumerate() {
                let goes_along = place.checked_sub(effects).is_some_and(|place| go_along[place]);
                *brings *= if goes_along { 1.0 } else { 0.0 };
            }
            added += &brings * brings.transpose() * second_moment(told, std, usual);
        }
        if added.trace() > most.trace() {
            most = added;
        }
    }
    most
}

/// Mean square of a size that is from none to `usual` on ordinary vehicles, where a flight tells `told` with an error `std`.
fn second_moment(told: f64, std: f64, usual: f64) -> f64 {
    let (by_flight, by_usage) = (std.powi(-2), 3.0 * usual.powi(-2));
    let variance = (by_flight + by_usage).recip();
    variance + (variance * by_flight * told).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_the_flight_tells_is_known_and_one_that_it_does_not_is_as_usual() {
        // 1 / (1/0.01 + 1/(1/3)) = 1/103, mean 100/103 * 0.5
        assert!((second_moment(0.5, 0.1, 1.0) - (0.009_709 + 0.235_649)).abs() < 1e-5);
        assert!((second_moment(3.0, 1e6, 0.2) - 0.04 / 3.0).abs() < 1e-9);
    }
}
