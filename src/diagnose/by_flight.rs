//! What each of several flights says of the vehicle's parameters, with its day's own beside them.
//!
//! Every flight is fitted alone to all that is known to act on the vehicle: its mass, its wind and its sensors are its own, and the
//! covariance of what is left has them in it. Put together by their information, such values are what one fit of all flights gives.

use super::base::Base;
use super::explain::ExplainSettings;
use super::explanation::{Explanation, Verdict};
use super::feedback_noise::is_fed_back;
use super::fit::{Fitted, Newton, fit};
use super::floors::add_floors;
use super::latency::LatencyFinding;
use super::latency_error::by_latency;
use super::latency_name::{FlightLatency, flight_latency, latency_of};
use super::left_over::add_left_over;
use super::limits::is_beyond_showing;
use super::named::Named;
use super::other_law::of_other_laws;
use super::own_wind::moves;
use super::reconstructed::{self, Forms, reconstruct};
use super::recorded::Recorded;
use super::signature::EffectTerm;
use super::signatures::{ALL, signature_of};
use super::stated_mass::by_stated_thrust;
use super::tested::Search;
use super::torque_law::ABOUT_Z;
use super::torques_by_instruments::torques_by_instruments;
use super::trace::Trace;
use super::vehicle_terms::{Owner, add_term, is_same, of_the_vehicle, owner};
use crate::estimate::{NAMES, UNITS};
use crate::physics::PhysicsError;
use crate::reconstruction::Path;
use crate::signals::{OwnOfFlight, Signals};
use crate::vehicle::Vehicle;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::sync::Arc;

/// Name of the vehicle's latency between command and rotor, delay and lag together, without that of a log.
pub const LATENCY: &str = "latency";

/// A parameter as one flight shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightParameter {
    /// `mass`, `ixx` ..., `latency`, or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// whose it is
    pub owner: Owner,
    /// effect of which it is; `None`: of the rigid body
    pub effect: Option<&'static str>,
    /// of a wind: 0 to north, 1 to west, 2 up
    pub wind_axis: Option<usize>,
    /// value at which the effect is none
    pub nothing: f64,
    /// value and standard error
    pub estimate: (f64, f64),
    /// part of that error which goes the same way in every flight of the vehicle: how far laws hold, and what they leave over
    pub common_std: f64,
}

/// The parameters of each flight, fitted with every effect of the vehicle that one of the explanations has, on the scale of the stated thrust
/// unless the vehicle was weighed; there is one explanation a flight, whose latency is among them. Empty where a flight cannot be fitted so.
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
        let mut base = with_terms(explanation, &terms, (vehicle, &trace));
        by_stated_thrust(&mut base, vehicle, trace.torques);
        let latency = latency_of(&trace, vehicle, &explanation.search.latency);
        let path = path_of(&base, explanation, 0);
        let of = (explanation.search.latency, Forms::Chosen);
        let fit = flight_fit((signals, &[trace]), (base, path), of).ok()?;
        let mut out = parameters(&fit, explanation, &terms, None);
        out.extend(latency.map(FlightParameter::from));
        Some(out)
    };
    let each: Vec<_> = flights.par_iter().zip(explanations).map(one).collect();
    each.into_iter().map(Option::unwrap_or_default).collect()
}

/// The parameters of each flight, fitted alone to the model of one explanation of all of them. A flight that drifts is seen with its own
/// wind, and what is left of the wind is a parameter of its day. `alone` is what each shows alone, where that is known: a centre of mass of its
/// own is beside the model of all, in which a rotor would stand for it.
#[must_use]
pub fn each_with_model_of_all(
    flights: &[Signals],
    (drifts, alone): (&[bool], &[Vec<Named>]),
    explanation: &Explanation,
    (vehicle, settings): (&Vehicle, &ExplainSettings),
) -> Vec<Vec<FlightParameter>> {
    let terms = of_the_vehicle(&[explanation]);
    let trace = |signals: &Signals| Trace::new(signals, vehicle, settings.half_width_s);
    let Ok(traces) = flights.iter().map(trace).collect::<Result<Vec<Trace>, _>>() else {
        return vec![Vec::new(); flights.len()];
    };
    let together = of_other_laws(&traces, &explanation.search.last, &explanation.search.after);
    let one = |(flight, ((signals, trace), drifts)): (usize, ((&Signals, &Trace), &bool))| {
        // whether a flight lacks an effect is what it tells
        let trace = &trace.with_own(OwnOfFlight { lacks: Arc::default(), ..trace.own.clone() });
        let own = std::slice::from_ref(trace);
        let mut base = with_terms(explanation, &terms, (vehicle, trace));
        if *drifts {
            base.effects.extend(wind_beside(&base));
        }
        let recorded = Recorded::new(vehicle, own);
        for term in
            alone.get(flight).into_iter().flatten().filter_map(|named| of_the_loading(named, &recorded))
        {
            add_term(&mut base.effects, &term, || true);
        }
        let latency = explanation.search.latency;
        let of_latency = flight_latency((own, &base), &explanation.named, vehicle).ok().flatten();
        let path = path_of(&base, explanation, flight);
        let fit = flight_fit((signals, own), (base, path), (latency, Forms::Known)).ok()?;
        let alone = of_other_laws(own, &[], &fit.fitted);
        let laws = OtherLaws { alone: &alone, together: &together, of_all: &explanation.search.after };
        let mut out = parameters(&fit, explanation, &terms, Some(&laws));
        if !moves(trace) {
            out.retain(|parameter| !is_of_air(parameter));
        }
        add_payload(&mut out, trace);
        out.extend(of_latency.map(FlightParameter::from));
        Some(out)
    };
    let each = flights.par_iter().zip(&traces).zip(drifts);
    each.enumerate().map(one).map(Option::unwrap_or_default).collect()
}

/// How a named effect of the vehicle's loading is looked for; `None` for other effects.
fn of_the_loading(named: &Named, recorded: &Recorded) -> Option<EffectTerm> {
    let signature = signature_of(named.id).filter(|of| of.role.of_the_loading)?;
    (signature.forms)(recorded).into_iter().next().map(|form| form.term)
}

/// What drags of other laws may bring into the coefficients: of one flight, and of all of them together.
struct OtherLaws<'a> {
    alone: &'a DMatrix<f64>,
    together: &'a DMatrix<f64>,
    /// fit of which the latter is
    of_all: &'a Fitted,
}

impl OtherLaws<'_> {
    /// Variance of a flight's coefficient in the place of `column`, and the part of it that all flights together do not lower.
    fn variances(&self, term: &EffectTerm, slot: usize, column: usize) -> (f64, f64) {
        let place = self.of_all.base.effects.iter().position(|present| is_same(present, term));
        let of_all = place.and_then(|place| reconstructed::column(self.of_all, place, slot));
        let together = of_all.map_or(0.0, |column| self.together[(column, column)]);
        (self.alone[(column, column)].max(together), together)
    }
}

impl From<FlightLatency> for FlightParameter {
    fn from(of: FlightLatency) -> Self {
        Self {
            name: LATENCY.to_owned(),
            unit: "s",
            owner: Owner::Vehicle,
            effect: Some(of.id),
            wind_axis: None,
            nothing: of.ordinary_s,
            estimate: of.estimate,
            common_std: of.common_std,
        }
    }
}

/// The parameters of one flight, fitted alone to its own explanation with a drag beside it, whether it was named or not: the flights of
/// a vehicle then have the same model, although none of them knows the others.
#[must_use]
pub fn of_one_flight(
    signals: &Signals,
    explanation: &Explanation,
    vehicle: &Vehicle,
    settings: &ExplainSettings,
) -> Vec<FlightParameter> {
    let Ok(trace) = Trace::new(signals, vehicle, settings.half_width_s) else { return Vec::new() };
    let mut terms = of_the_vehicle(&[explanation]);
    let drags = |term: &EffectTerm| term.signature.role.of_air && term.signature.is_drag();
    if !terms.iter().any(drags) {
        let recorded = Recorded::new(vehicle, std::slice::from_ref(&trace));
        // the plainest form of a drag whose size grows with the speed alone
        let plain = ALL.iter().find(|signature| signature.role.with_speed.is_some());
        let forms = plain.map_or_else(Vec::new, |signature| (signature.forms)(&recorded));
        terms.extend(forms.into_iter().map(|form| form.term).find(drags));
    }
    let mut base = with_terms(explanation, &terms, (vehicle, &trace));
    by_stated_thrust(&mut base, vehicle, trace.torques);
    let path = path_of(&base, explanation, 0);
    let fit = flight_fit((signals, &[trace]), (base, path), (explanation.search.latency, Forms::Chosen)).ok();
    fit.map_or_else(Vec::new, |fit| parameters(&fit, explanation, &terms, None))
}

/// A wind along the ground, about none, where a force of the air is there through which it acts.
fn wind_beside(base: &Base) -> Option<EffectTerm> {
    let acts = base.effects.iter().any(|term| term.signature.role.of_air);
    let is_there = base.effects.iter().any(|term| term.signature.role.wind.is_some());
    let carried = ALL.iter().find_map(|signature| signature.role.wind)?().into_iter().next()?;
    (acts && !is_there).then_some(carried.term)
}

/// The rigid body's parameters of each flight, fitted without any effect.
#[must_use]
pub fn rigid_by_flight(
    flights: &[Signals],
    explanation: &Explanation,
    vehicle: &Vehicle,
    settings: &ExplainSettings,
) -> Vec<Vec<FlightParameter>> {
    let one = |signals: &Signals| {
        let trace = Trace::new(signals, vehicle, settings.half_width_s).ok()?;
        let (base, own) = (explanation.search.before.base.clone(), std::slice::from_ref(&trace));
        let fit =
            flight_fit((signals, own), (base, None), (explanation.search.latency, Forms::Known)).ok()?;
        let mut out = parameters(&fit, explanation, &[], None);
        add_payload(&mut out, &trace);
        Some(out)
    };
    flights.par_iter().map(one).map(Option::unwrap_or_default).collect()
}

/// The mass of a flight is that of the vehicle with its payload.
fn add_payload(parameters: &mut [FlightParameter], trace: &Trace) {
    parameters.iter_mut().filter(|of| is_mass(of)).for_each(|mass| mass.estimate.0 += trace.own.payload_kg);
}

fn is_mass(parameter: &FlightParameter) -> bool {
    parameter.effect.is_none() && parameter.name == NAMES[0]
}

/// Whether the parameter is that of a force of the air.
fn is_of_air(parameter: &FlightParameter) -> bool {
    let signature = parameter.effect.and_then(signature_of);
    signature.is_some_and(|signature| signature.role.of_air || signature.role.wind.is_some())
}

/// The model of one flight with the effects of all that it can show.
fn with_terms(explanation: &Explanation, terms: &[EffectTerm], (vehicle, trace): (&Vehicle, &Trace)) -> Base {
    let search = &explanation.search;
    let own = if explanation.verdict == Verdict::Unexplained { &search.before } else { &search.after };
    let mut base = own.base.clone();
    let recorded = Recorded::new(vehicle, std::slice::from_ref(trace));
    for term in terms {
        add_term(&mut base.effects, term, || recorded.lacks(term.signature.needs).is_none());
    }
    base
}

/// The path of a flight that an explanation found, if the model has the same effects. A fit that begins there keeps the noise levels, which
/// contain all that those effects do not explain.
fn path_of<'a>(base: &Base, explanation: &'a Explanation, flight: usize) -> Option<&'a Path> {
    let (own, found) = (&base.effects, &explanation.search.after.base.effects);
    let is_same_model =
        own.len() == found.len() && own.iter().zip(found).all(|(own, found)| is_same(own, found));
    explanation.search.paths.get(flight).filter(|_| is_same_model)
}

/// One flight fitted to a model, its sizes and errors as an explanation has them, but for what all flights have in common.
struct FlightFit {
    fitted: Fitted,
    /// the coefficients that instruments have told
    by_instruments: Vec<usize>,
    /// covariance that the error of the latency brings
    by_latency: DMatrix<f64>,
}

/// The fit of one flight. It begins at a path that is known.
fn flight_fit(
    (signals, traces): (&Signals, &[Trace]),
    (base, path): (Base, Option<&Path>),
    (latency, forms): (LatencyFinding, Forms),
) -> Result<FlightFit, PhysicsError> {
    let after = fit(traces, base, Newton::Held)?;
    let mut found = Search { paths: path.cloned().into_iter().collect(), ..Search::of(after, latency) };
    reconstruct(std::slice::from_ref(signals), traces, (forms, &mut found), None)?;
    let by_instruments = if is_fed_back(traces) {
        torques_by_instruments(traces, latency.std_s, &mut found.after)?
    } else {
        Vec::new()
    };
    let by_latency = by_latency(traces, &found.after, (latency.told_std_s(), &by_instruments))?;
    Ok(FlightFit { fitted: found.after, by_instruments, by_latency })
}

/// What a fit says. Flights that are compared have a spread for other laws of drag; where they are put together, `laws` are in the errors.
fn parameters(
    FlightFit { fitted, by_instruments, by_latency }: &FlightFit,
    explanation: &Explanation,
    terms: &[EffectTerm],
    laws: Option<&OtherLaws<'_>>,
) -> Vec<FlightParameter> {
    let mut whole = fitted.clone();
    add_left_over(&mut whole, by_instruments);
    whole.covariance += by_latency;
    add_floors(&mut whole);
    let common = |own: f64, all: f64| (all - own).max(0.0).sqrt();
    let mut out = Vec::new();
    let body = fitted.rigid_body().with_wider_window(explanation.search.by_wider_window);
    let with_common = whole.rigid_body();
    let tells_inertia = fitted.rows.compares_torques && !explanation.turned_by_control;
    // another law of the rotors' torque than the stated one leaves izz open; products say nothing that the moments do not
    let tells = |index| tells_inertia && (index != ABOUT_Z || explanation.torque_law.is_none());
    for index in [0, 1, 4, ABOUT_Z].into_iter().filter(|&index| index == 0 || tells(index)) {
        let variance = body.covariance[(index, index)];
        if body.theta[index].is_finite() && variance > 0.0 && body.is_of_all_bands(index) {
            out.push(FlightParameter {
                name: NAMES[index].to_owned(),
                unit: UNITS[index],
                owner: if index == 0 { Owner::Flight } else { Owner::Vehicle },
                effect: None,
                wind_axis: None,
                nothing: 0.0,
                estimate: (body.theta[index], with_common.covariance[(index, index)].sqrt()),
                common_std: common(variance, with_common.covariance[(index, index)]),
            });
        }
    }
    let mut column = fitted.rows.nuisances.len();
    for present in &fitted.base.effects {
        // a flight that could not show the effect tells nothing of it, and a size at its bound is that of something else
        let possible = !is_beyond_showing(fitted, present, column);
        for &slot in &present.free {
            let is_known = terms.iter().any(|term| is_same(term, present)) || owner(present) == Owner::Flight;
            let is_known = is_known && possible && !present.ends_at_bound(slot, &fitted.base.size);
            if let Some(parameter) = present.parameter(slot).filter(|_| present.is_amount(slot) && is_known) {
                let value = present.values[slot];
                let std = fitted.std_of(column, (value, parameter.unit));
                let of_whole = whole.std_of(column, (value, parameter.unit));
                let none = (0.0, 0.0);
                let (alone, together) = laws.map_or(none, |laws| laws.variances(present, slot, column));
                out.extend((std > 0.0).then(|| FlightParameter {
                    name: named(present, parameter.name),
                    unit: parameter.unit,
                    owner: owner(present),
                    effect: Some(present.id()),
                    wind_axis: present.signature.role.wind.map(|_| slot),
                    nothing: present.signature.nothing,
                    estimate: (value, of_whole.hypot(alone.sqrt())),
                    common_std: common(std * std, of_whole * of_whole).hypot(together.sqrt()),
                }));
            }
            column += 1;
        }
    }
    out
}

/// `effect.parameter`, of a rotor with its number.
pub(super) fn named(term: &EffectTerm, parameter: &str) -> String {
    match term.signature.role.which {
        Some(slot) => format!("{}[{}].{parameter}", term.id(), term.values[slot]),
        None => format!("{}.{parameter}", term.id()),
    }
}
