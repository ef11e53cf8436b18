//! What a drag of another law, which the flight does not show, may do to the sizes of the one that it shows.
//!
//! Within the speeds of one flight a drag in proportion to the airspeed and one with its square are nearly the same force. Where the
//! model has one of them, the other may be there as well, at the size that ordinary vehicles have, as far as the flight does not
//! exclude it. What it brings into the other sizes belongs to their standard errors (consider covariance).

use super::candidates::{Candidate, candidates};
use super::evidence::{Evidence, weighted};
use super::fit::Fitted;
use super::score::columns_of;
use super::signature::EffectTerm;
use super::signatures::ALL;
use super::tested::Tested;
use super::trace::Trace;
use nalgebra::{DMatrix, DVector};

/// Most units of one law that one unit of another one can be, SI: the ratio of both forces at speeds from 0.02 to 50 m/s.
const MOST_OF_OTHER: f64 = 50.0;

/// Adds to the covariance of a fit's effects what the drag laws among the candidates that were not taken may bring into them. Returns the
/// variances that it adds to the free values of the effects.
pub(super) fn add_other_laws(flights: &[Trace], last: &[Tested], fitted: &mut Fitted) -> Vec<f64> {
    let added = of_other_laws(flights, last, fitted);
    fitted.covariance += &added;
    added.diagonal().iter().skip(fitted.rows.nuisances.len()).copied().collect()
}

/// A drag law that a fit does not have.
struct Law {
    part: EffectTerm,
    /// `None`: the flights cannot tell it from what the fit has
    evidence: Option<Evidence>,
}

impl Law {
    /// What the flights tell of one of its coefficients, with the standard error, SI.
    fn told(&self, index: usize) -> (f64, f64) {
        self.evidence.as_ref().map_or((0.0, f64::INFINITY), |of| (of.theta[index], of.std(index)))
    }
}

/// The drag laws that a fit does not have: those in `last` as they were tested, the others tested on its flights. Where they tell one
/// form of a law, that form stands for those that they do not.
fn other_laws(flights: &[Trace], last: &[Tested], fitted: &Fitted) -> Vec<Law> {
    let tested = last.iter().filter(|tested| is_other_law(&tested.candidate, fitted));
    let as_tested = |tested: &Tested| {
        Some(Law { part: tested.candidate.parts.first()?.clone(), evidence: Some(tested.evidence.clone()) })
    };
    let mut laws: Vec<Law> = tested.filter_map(as_tested).collect();
    let mut others = candidates(&fitted.base.vehicle, flights, ALL);
    others.retain(|other| is_other_law(other, fitted) && laws.iter().all(|law| law.part.id() != other.id));
    laws.extend(others.iter().filter_map(|candidate| {
        let columns = columns_of(flights, fitted, candidate)?;
        Some(Law { part: candidate.parts.first()?.clone(), evidence: fitted.weighted.test(&columns) })
    }));
    let told = laws.iter().filter(|law| law.evidence.is_some());
    let told: Vec<&str> = told.map(|law| law.part.id()).collect();
    laws.retain(|law| law.evidence.is_some() || !told.contains(&law.part.id()));
    laws
}

/// A drag alone, of a law that the fit does not have.
fn is_other_law(candidate: &Candidate, fitted: &Fitted) -> bool {
    let [part] = candidate.parts.as_slice() else { return false };
    let is_new = || fitted.base.effects.iter().all(|present| !present.is(part.signature));
    candidate.through.is_none() && part.signature.is_drag() && is_new()
}

/// Covariance that the drag laws that a fit does not have may bring into its coefficients; `last` are candidates that were tested on
/// the same flights. Of several laws it is that of the one which widens the standard errors most.
pub(super) fn of_other_laws(flights: &[Trace], last: &[Tested], fitted: &Fitted) -> DMatrix<f64> {
    let count = fitted.covariance.nrows();
    let mut most: DMatrix<f64> = DMatrix::zeros(count, count);
    if !fitted.base.effects.iter().any(|term| term.signature.is_drag()) {
        return most;
    }
    // a drag along z is told from an inflow by the search
    let with_air = |term: &EffectTerm| term.signature.is_drag() || term.signature.role.wind.is_some();
    let present = &fitted.base.effects;
    let go_along: Vec<bool> = present.iter().flat_map(|term| vec![with_air(term); term.free.len()]).collect();
    let first = fitted.weighted.nuisances.len().saturating_sub(go_along.len());
    let is_drag = present
        .iter()
        .flat_map(|term| term.free.iter().map(|&slot| term.signature.is_drag() && term.is_amount(slot)));
    let drag_columns: Vec<usize> =
        is_drag.enumerate().filter(|(_, is)| *is).map(|(place, _)| first + place).collect();
    let mut widest = 0.0;
    for law in other_laws(flights, last, fitted) {
        let part = &law.part;
        let Ok(columns) = fitted.rows.columns_of(flights, &fitted.base, part) else { continue };
        let mut added = DMatrix::zeros(count, count);
        for (index, (column, &slot)) in columns.iter().zip(&part.free).enumerate() {
            let Some(parameter) = part.parameter(slot) else { continue };
            let usual = (part.signature.naming.usual)(parameter.name, &fitted.base.vehicle);
            let Some(usual) = usual else { continue };
            let (told, std) = law.told(index);
            let column = weighted(column, &fitted.weighted.sigma);
            let mut brings: DVector<f64> = fitted.weighted.part_in(&column);
            let effects = brings.len() - go_along.len();
            for (place, brings) in brings.iter_mut().enumerate() {
                let goes_along = place.checked_sub(effects).is_some_and(|place| go_along[place]);
                *brings *= if goes_along { 1.0 } else { 0.0 };
            }
            // the flights then hardly tell the drag's own coefficient, and what would come into it means nothing
            if drag_columns.iter().any(|&index| brings[index].abs() > MOST_OF_OTHER) {
                continue;
            }
            added += &brings * brings.transpose() * second_moment(told, std, usual);
        }
        let widens = share(&added, &fitted.covariance);
        if widens > widest {
            (most, widest) = (added, widens);
        }
    }
    most
}

/// Sum of what is added to the coefficients' variances, each as a share of its own: coefficients have different units.
fn share(added: &DMatrix<f64>, covariance: &DMatrix<f64>) -> f64 {
    let (added, covariance) = (added.diagonal(), covariance.diagonal());
    let known = added.iter().zip(covariance.iter()).filter(|(_, variance)| **variance > 0.0);
    known.map(|(added, variance)| added / variance).sum()
}

/// Mean square of a size that is from none to `usual` on ordinary vehicles, where a flight tells `told` with an error `std`.
pub(super) fn second_moment(told: f64, std: f64, usual: f64) -> f64 {
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
        assert!((second_moment(0.0, f64::INFINITY, 0.2) - 0.04 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn which_law_widens_more_does_not_depend_on_units() {
        // a drag, N/(m/s), and a wind, m/s
        let covariance = DMatrix::from_diagonal(&DVector::from_vec(vec![1e-4, 1.0]));
        let added = |variances: [f64; 2]| DMatrix::from_diagonal(&DVector::from_vec(variances.to_vec()));
        let (of_drag, of_wind) = (added([4e-4, 0.1]), added([0.0, 0.5]));
        assert!(of_wind.trace() > of_drag.trace());
        assert!((share(&of_drag, &covariance) - 4.1).abs() < 1e-12);
        assert!((share(&of_wind, &covariance) - 0.5).abs() < 1e-12);
        assert!(share(&of_wind, &DMatrix::zeros(2, 2)).abs() < 1e-12);
    }
}
