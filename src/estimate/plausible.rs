//! Checks of implausible results: another vehicle, a wrong unit, two vehicles at once.

use super::result::{Finding, MethodResult};
use super::theta::{NAMES, Theta};
use super::weak::{WeakMethod, solve_weak};
use crate::note::{About, Note};
use crate::regression::WeakRows;

/// Largest ratio of the identified mass to that of the vehicle file, or its inverse, without a warning. Chosen; not
/// measured.
const MASS_FACTOR: f64 = 1.5;
/// The same for a moment of inertia. Chosen; not measured.
const INERTIA_FACTOR: f64 = 3.0;
/// Standard errors of the difference within which the masses of two flights of one vehicle agree. Chosen; not measured.
const FLIGHTS_SIGMA: f64 = 6.0;
/// Relative difference within which they agree. Chosen; not measured.
const FLIGHTS_SHARE: f64 = 0.02;

/// A parameter that is far from what the vehicle file states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contradiction {
    /// as in files
    pub name: &'static str,
    /// estimate over stated value
    pub factor: f64,
}

/// Estimates that are far from what the vehicle file states: a mass by a factor of 1.5, a moment of inertia by 3.
#[must_use]
pub fn contradictions(result: &MethodResult, nominal: &Theta) -> Vec<Contradiction> {
    [(0, MASS_FACTOR), (1, INERTIA_FACTOR), (4, INERTIA_FACTOR), (6, INERTIA_FACTOR)]
        .into_iter()
        .filter_map(|(index, most)| {
            let Finding::Determined { value, .. } = result.parameters[index].finding else { return None };
            let factor = value / nominal[index];
            (factor > most || factor < 1.0 / most).then_some(Contradiction { name: NAMES[index], factor })
        })
        .collect()
}

/// Notes on estimates far from the vehicle file.
pub(super) fn implausible(result: &MethodResult, nominal: &Theta) -> Vec<Note> {
    let warning = |Contradiction { name, factor }| {
        let text = format!(
            "{name} is {factor:.2} times what the vehicle file states: is it another vehicle's log, is a unit wrong, or \
             are thrust and torque coefficients wrong by this factor? A weighed mass with anchor = \"mass\" sets the scale"
        );
        Note::warning(About::Estimate, text)
    };
    contradictions(result, nominal).into_iter().map(warning).collect()
}

/// Notes on flights with contradicting masses.
#[must_use]
pub fn disagreeing(flights: &[WeakRows], nominal: &Theta) -> Vec<Note> {
    if flights.len() < 2 {
        return Vec::new();
    }
    let masses: Vec<Option<(f64, f64)>> = flights
        .iter()
        .map(|rows| {
            let alone = solve_weak(std::slice::from_ref(rows), nominal, WeakMethod::LeastSquares)?;
            let std = alone.covariance[(0, 0)].sqrt();
            (alone.theta[0].is_finite() && std.is_finite()).then_some((alone.theta[0], std))
        })
        .collect();
    let Some((first, first_std)) = masses.first().copied().flatten() else { return Vec::new() };
    masses
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(|(index, mass)| {
            let (mass, std) = (*mass)?;
            let sigma = (mass - first).abs() / first_std.hypot(std);
            (sigma > FLIGHTS_SIGMA && (mass / first - 1.0).abs() > FLIGHTS_SHARE).then(|| {
                let text = format!(
                    "flight {} alone gives a mass of {mass:.4} kg, flight 1 {first:.4} kg, {sigma:.0} standard errors apart: \
                     two vehicles or two loads? The common estimate describes neither",
                    index + 1
                );
                Note::warning(About::Estimate, text)
            })
        })
        .collect()
}
