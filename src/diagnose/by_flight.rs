//! What each of several flights says of the vehicle's parameters, with its day's own beside them.
//!
//! Every flight is fitted alone to all that any of them shows of the vehicle: its mass, its wind and its sensors are its own, and the
//! covariance of what is left has them in it. Put together by their information, such values are what one fit of all flights gives.

use super::base::Base;
use super::explain::ExplainSettings;
use super::explanation::{Explanation, Verdict};
use super::fit::{Fitted, Newton, fit};
use super::recorded::Recorded;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::estimate::{NAMES, THETA, UNITS};
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// Whose a parameter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// the same in every flight
    Vehicle,
    /// of the day: load and battery
    Flight,
}

/// A parameter as one flight shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightParameter {
    /// `mass`, `ixx` ... or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// whose it is
    pub owner: Owner,
    /// effect of which it is; `None`: of the rigid body
    pub effect: Option<&'static str>,
    /// value and standard error
    pub estimate: (f64, f64),
}

/// The parameters of each flight, fitted with every effect of the vehicle that one of the explanations has; there is one explanation a
/// flight. Empty where a flight cannot be fitted so.
#[must_use]
pub fn by_flight(
    flights: &[Signals],
    explanations: &[&Explanation],
    vehicle: &Vehicle,
    settings: &ExplainSettings,
) -> Vec<Vec<FlightParameter>> {
    let terms = of_the_vehicle(explanations);
    let one = |(signals, explanation): (&Signals, &&Explanation)| {
        let trace = Trace::new(signals, vehicle, settings.half_width_s).ok()?;
        let base = with_terms(explanation, &terms, (vehicle, &trace));
        let traces = [trace];
        let fitted = fit(&traces, base, Newton::Held).ok()?;
        Some(parameters(&fitted, explanation, &terms))
    };
    let each: Vec<_> = flights.par_iter().zip(explanations).map(one).collect();
    each.into_iter().map(Option::unwrap_or_default).collect()
}

/// Whether an effect stays with the vehicle from flight to flight.
fn is_of_the_vehicle(term: &EffectTerm) -> bool {
    let role = &term.signature.role;
    !role.of_the_day && role.moment.is_none() && !term.free.is_empty()
}

/// Each effect of the vehicle that was named, once; each rotor may have its own.
fn of_the_vehicle(explanations: &[&Explanation]) -> Vec<EffectTerm> {
    let mut terms: Vec<EffectTerm> = Vec::new();
    for explanation in explanations.iter().filter(|one| one.verdict != Verdict::Unexplained) {
        let named = |term: &&EffectTerm| explanation.named.iter().any(|named| named.id == term.id());
        for term in explanation.search.after.base.present.iter().filter(named) {
            if is_of_the_vehicle(term) && !terms.iter().any(|known| is_same(known, term)) {
                terms.push(term.clone());
            }
        }
    }
    terms
}

fn is_same(one: &EffectTerm, other: &EffectTerm) -> bool {
    let which = one.signature.role.which;
    one.id() == other.id() && which.is_none_or(|slot| one.values[slot] == other.values[slot])
}

/// The model of one flight with the effects of all that it can show.
fn with_terms(explanation: &Explanation, terms: &[EffectTerm], (vehicle, trace): (&Vehicle, &Trace)) -> Base {
    let search = &explanation.search;
    let own = if explanation.verdict == Verdict::Unexplained { &search.before } else { &search.after };
    let mut base = own.base.clone();
    let recorded = Recorded::new(vehicle, std::slice::from_ref(trace));
    for term in terms {
        let is_there = base.present.iter().any(|present| is_same(present, term));
        if !is_there && recorded.lacks(term.signature.needs).is_none() {
            base.present.push(term.clone());
        }
    }
    base
}

fn parameters(fitted: &Fitted, explanation: &Explanation, terms: &[EffectTerm]) -> Vec<FlightParameter> {
    let mut out = Vec::new();
    let body = fitted.rigid_body();
    let tells_inertia = fitted.rows.compares_torques && !explanation.turned_by_control;
    // products say nothing that the moments do not
    for index in [0, 1, 4, 6].into_iter().filter(|index| *index < THETA && (*index == 0 || tells_inertia)) {
        let std = body.covariance[(index, index)].max(0.0).sqrt();
        if body.theta[index].is_finite() && std > 0.0 {
            let owner = if index == 0 { Owner::Flight } else { Owner::Vehicle };
            let estimate = (body.theta[index], std);
            out.push(FlightParameter {
                name: NAMES[index].to_owned(),
                unit: UNITS[index],
                owner,
                effect: None,
                estimate,
            });
        }
    }
    let mut column = fitted.rows.nuisances.len();
    for present in &fitted.base.present {
        for &slot in &present.free {
            if let Some(parameter) = present.parameter(slot) {
                let is_amount = present.signature.amounts.contains(&slot);
                let is_known = terms.iter().any(|term| is_same(term, present));
                let day = present.signature.role.of_the_day;
                let estimate =
                    (present.values[slot], fitted.std_of(column, (present.values[slot], parameter.unit)));
                if is_amount && (is_known || day) && estimate.1 > 0.0 {
                    out.push(FlightParameter {
                        name: named(present, parameter.name),
                        unit: parameter.unit,
                        owner: if day { Owner::Flight } else { Owner::Vehicle },
                        effect: Some(present.id()),
                        estimate,
                    });
                }
            }
            column += 1;
        }
    }
    out
}

/// `effect.parameter`, of a rotor with its number.
fn named(term: &EffectTerm, parameter: &str) -> String {
    match term.signature.role.which {
        Some(slot) => format!("{}[{}].{parameter}", term.id(), term.values[slot]),
        None => format!("{}.{parameter}", term.id()),
    }
}
