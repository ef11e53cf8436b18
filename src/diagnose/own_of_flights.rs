//! What each of several flights has its own, before they are explained together: a payload, a rotor that is weak in one of them only, a load
//! that is dropped.
//!
//! A quick fit of each flight tells whether they differ at all. If they do, each is explained alone, and fitted to all that one of them shows.

use super::base::Base;
use super::by_flight::{FlightParameter, by_flight, named};
use super::candidates::candidates;
use super::channels::Nuisance;
use super::explain::{ExplainSettings, explain};
use super::explanation::{Explanation, Verdict};
use super::fit::{Newton, fit};
use super::named::Named;
use super::recorded::Need;
use super::score::columns_of;
use super::signature::{EffectTerm, Role, Signature};
use super::signatures::ALL;
use super::trace::Trace;
use super::vehicle_terms::Owner;
use crate::signals::{Lacking, OwnOfFlight, Series, Signals};
use crate::vehicle::{Anchor, Vehicle};
use rayon::prelude::*;
use std::ops::Range;

/// Standard errors from which on flights differ. Set by judgement: above those of a name, because each pair of flights is compared.
const CERTAIN: f64 = 5.0;
/// Least share of the mass that is a payload. Set by judgement: errors of the thrust law and of a battery are as large as half of it.
const LEAST_OF_MASS: f64 = 0.03;
/// Least difference of a rotor's factor that counts.
const LEAST_OF_ROTOR: f64 = 0.02;
/// Exponents of the voltage with which thrust may fall as a battery does: between half of the plain ratio, and a half more than that of
/// rotors whose speed goes with the voltage.
const SAG: Range<f64> = 0.5..3.0;
/// Share of an effect's size below which a flight has not that effect.
const SHOWN: f64 = 0.5;
/// Standard errors from which on a flight tells an effect from none, and from that of the others. The usual three.
const TELLS: f64 = 3.0;

/// What tells flights of one vehicle apart.
#[derive(Debug, Clone, Default)]
pub struct Apart {
    /// what each has its own; empty where that is nothing
    pub own: Vec<OwnOfFlight>,
    /// what each shows alone; empty where nothing tells the flights apart. Of a flight that is not explained alone there are no names
    pub alone: Vec<Vec<Named>>,
}

/// What tells flights apart; nothing where they are alike.
#[must_use]
pub fn apart(flights: &[Signals], vehicle: &Vehicle, settings: &ExplainSettings) -> Apart {
    let looks: Vec<Option<Look>> =
        flights.par_iter().map(|signals| Look::at(signals, vehicle, settings)).collect();
    let Some(looks) = looks.into_iter().collect::<Option<Vec<Look>>>() else { return Apart::default() };
    let differs = |(at, one): (usize, &Look)| looks[at + 1..].iter().any(|other| one.differs(other));
    if !looks.iter().any(|look| look.changes) && !looks.iter().enumerate().any(differs) {
        return Apart::default();
    }
    let alone = |signals: &Signals| explain(std::slice::from_ref(signals), vehicle, settings).ok();
    let alone: Vec<Option<Explanation>> = flights.par_iter().map(alone).collect();
    let Some(alone) = alone.into_iter().collect::<Option<Vec<Explanation>>>() else {
        return Apart::default();
    };
    let names = |alone: &Explanation| {
        if alone.verdict == Verdict::Unexplained { Vec::new() } else { alone.named.clone() }
    };
    let voltages_v: Vec<Option<f64>> = looks.iter().map(|look| look.voltage_v).collect();
    let own = own_of((flights, &voltages_v), &alone, vehicle, settings);
    Apart { own, alone: alone.iter().map(names).collect() }
}

fn own_of(
    (flights, voltages_v): (&[Signals], &[Option<f64>]),
    alone: &[Explanation],
    vehicle: &Vehicle,
    settings: &ExplainSettings,
) -> Vec<OwnOfFlight> {
    let each = by_flight(flights, &alone.iter().collect::<Vec<_>>(), vehicle, settings);
    if each.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    let terms = own_terms(alone);
    // the voltage to which a flight's mass belongs is its own: all flights together tell them apart
    let by_voltage = |flight: usize| {
        let mut of_voltage = terms.iter().filter(|term| term.signature.needs.contains(&Need::Voltage));
        of_voltage.any(|term| !lacks(term, flight, &each))
    };
    let masses = masses(&each, alone, vehicle).into_iter().enumerate();
    let masses: Vec<Option<(f64, f64)>> =
        masses.map(|(flight, mass)| mass.filter(|_| !by_voltage(flight))).collect();
    let payloads = payloads_kg(&masses, voltages_v, vehicle);
    let own = |(flight, payload_kg): (usize, f64)| OwnOfFlight {
        payload_kg,
        lacks: terms.iter().filter(|term| lacks(term, flight, &each)).map(lacking).collect(),
        has: moments(&alone[flight]).map(|term| (term.id(), term.values.clone())).collect(),
    };
    let own: Vec<OwnOfFlight> = payloads.into_iter().enumerate().map(own).collect();
    for (flight, own) in own.iter().enumerate().filter(|(_, own)| !own.is_none()) {
        tracing::info!(flight, ?own, "a flight has something its own");
    }
    if own.iter().all(OwnOfFlight::is_none) { Vec::new() } else { own }
}

/// What a quick fit of a flight shows.
struct Look {
    /// kg by the stated thrust, with its standard error
    mass: (f64, f64),
    /// V, mean over the rows; `None` where it is not recorded
    voltage_v: Option<f64>,
    /// how much each rotor lacks, with its standard error
    rotors: Vec<(f64, f64)>,
    /// something seems to change at a moment of the flight, which no two flights have in common
    changes: bool,
}

impl Look {
    fn at(signals: &Signals, vehicle: &Vehicle, settings: &ExplainSettings) -> Option<Self> {
        let traces = [Trace::new(signals, vehicle, settings.half_width_s).ok()?];
        let mut base = Base::anchored(vehicle);
        let known = &traces[0].known;
        if known.velocity && known.attitude {
            let mut drag =
                ALL.iter().find_map(|signature| signature.role.wind)?().into_iter().next()?.carrier;
            drag.free.clone().iter().for_each(|&slot| drag.values[slot] = 0.0);
            base.effects.push(drag);
        }
        let fitted = fit(&traces, base, Newton::Free).ok()?;
        let estimated = fitted.with_stated_thrust(&vehicle.propulsion);
        let index = fitted.rows.nuisances.iter().position(|of| of.nuisance == Nuisance::Mass)?;
        let share = fitted.covariance[(index, index)].max(0.0).sqrt() / fitted.base.vehicle.body.mass_kg;
        let all = candidates(vehicle, &traces, ALL);
        let sizes = |is_asked: fn(&Role) -> bool| {
            let asked = all
                .iter()
                .filter(move |of| of.signature().is_some_and(|signature| is_asked(&signature.role)));
            asked.filter_map(|candidate| {
                let evidence = fitted.weighted.test(&columns_of(&traces, &fitted, candidate)?)?;
                Some((candidate, (*evidence.theta.first()?, evidence.std(0))))
            })
        };
        let rotors = sizes(|role| role.which.is_some()).map(|(_, size)| size).collect();
        let mass_kg = fitted.base.vehicle.body.mass_kg;
        let changes = sizes(|role| role.moment.is_some()).any(|(candidate, (size, std))| {
            let least = candidate.signature().map_or(0.0, |of| of.naming.least_of_mass * mass_kg);
            size.abs() > (CERTAIN * std).max(least)
        });
        let mass_kg = estimated.theta[0];
        let mean = |volts: &Series<f64>| {
            let rows = &traces[0].centers;
            rows.iter().map(|&row| volts[row]).sum::<f64>() / rows.len().max(1) as f64
        };
        Some(Self {
            mass: (mass_kg, share * mass_kg),
            voltage_v: traces[0].voltage_v.as_ref().map(mean),
            rotors,
            changes,
        })
    }

    fn differs(&self, other: &Self) -> bool {
        let is = |(one, other): (&(f64, f64), &(f64, f64)), least: f64| {
            let by = (one.0 - other.0).abs();
            by > CERTAIN * one.1.hypot(other.1) && by > least
        };
        is((&self.mass, &other.mass), 0.5 * LEAST_OF_MASS * self.mass.0)
            || self.rotors.iter().zip(&other.rotors).any(|pair| is(pair, LEAST_OF_ROTOR))
    }
}

/// Mass of each flight at its beginning by the stated thrust, kg, with its standard error.
fn masses(
    each: &[Vec<FlightParameter>],
    alone: &[Explanation],
    vehicle: &Vehicle,
) -> Vec<Option<(f64, f64)>> {
    let of = |(parameters, alone): (&Vec<FlightParameter>, &Explanation)| {
        if vehicle.anchor == Anchor::Mass {
            let fitted = &alone.search.after;
            let by_thrust = fitted.with_stated_thrust(&vehicle.propulsion);
            let share = fitted.covariance[(0, 0)].max(0.0).sqrt() / fitted.base.vehicle.body.mass_kg;
            return by_thrust.theta[0].is_finite().then(|| (by_thrust.theta[0], share * by_thrust.theta[0]));
        }
        parameters.iter().find(|of| of.effect.is_none() && of.owner == Owner::Flight).map(|of| of.estimate)
    };
    each.iter().zip(alone).map(of).collect()
}

/// What each flight carries more than that whose mass is the nearest to the file's, kg. What its battery explains is no payload.
fn payloads_kg(masses: &[Option<(f64, f64)>], voltages_v: &[Option<f64>], vehicle: &Vehicle) -> Vec<f64> {
    let stated_kg = vehicle.body.mass_kg;
    let known = masses.iter().zip(voltages_v).filter_map(|(mass, volts)| Some((mass.as_ref()?, volts)));
    let nearest = known.min_by(|(a, _), (b, _)| {
        let apart = |of: &(f64, f64)| (of.0 / stated_kg).ln().abs();
        apart(a).total_cmp(&apart(b))
    });
    let Some((&(kg, std_kg), volts)) = nearest else { return vec![0.0; masses.len()] };
    let to_scale = if vehicle.anchor == Anchor::Mass { stated_kg / kg } else { 1.0 };
    let more = |(of, own_volts): (&Option<(f64, f64)>, &Option<f64>)| {
        let &(own_kg, own_std) = of.as_ref()?;
        let by = own_kg - kg;
        let is_certain = by.abs() > CERTAIN * own_std.hypot(std_kg) && by.abs() > LEAST_OF_MASS * kg;
        let sags = own_volts
            .zip(*volts)
            .is_some_and(|(own, other)| SAG.contains(&((own_kg / kg).ln() / (other / own).ln())));
        (is_certain && !sags).then_some(by * to_scale)
    };
    masses.iter().zip(voltages_v).map(|of| more(of).unwrap_or(0.0)).collect()
}

/// Effects that some flights of a vehicle may have and others not, as the flights alone name them, each once.
fn own_terms(alone: &[Explanation]) -> Vec<EffectTerm> {
    let mut terms: Vec<EffectTerm> = Vec::new();
    for explanation in alone.iter().filter(|alone| alone.verdict != Verdict::Unexplained) {
        for term in named_terms(explanation).filter(|term| may_be_own(term.signature)) {
            if !terms.iter().any(|known| lacking(known) == lacking(term)) {
                terms.push(term.clone());
            }
        }
    }
    terms
}

/// A rotor, or the battery.
fn may_be_own(signature: &Signature) -> bool {
    signature.role.which.is_some() || signature.needs.contains(&Need::Voltage)
}

fn named_terms(explanation: &Explanation) -> impl Iterator<Item = &EffectTerm> {
    let is_named = |term: &&EffectTerm| explanation.named.iter().any(|named| named.id == term.id());
    explanation.search.after.base.effects.iter().filter(is_named)
}

/// Changes at a moment of a flight.
fn moments(explanation: &Explanation) -> impl Iterator<Item = &EffectTerm> {
    let is_explained = explanation.verdict != Verdict::Unexplained;
    named_terms(explanation).filter(move |term| is_explained && term.signature.role.moment.is_some())
}

fn lacking(term: &EffectTerm) -> Lacking {
    Lacking { effect: term.id(), which: term.signature.role.which.map(|slot| term.values[slot]) }
}

/// Whether a flight tells that it has not an effect which another one has.
fn lacks(term: &EffectTerm, flight: usize, each: &[Vec<FlightParameter>]) -> bool {
    let Some(&slot) = term.signature.amounts.first() else { return false };
    let Some(name) = term.parameter(slot).map(|parameter| named(term, parameter.name)) else {
        return false;
    };
    let beyond = |flight: usize| {
        let of = each[flight].iter().find(|of| of.name == name)?;
        Some((of.estimate.0 - of.nothing, of.estimate.1))
    };
    let has = (0..each.len()).filter(|other| *other != flight).filter_map(beyond);
    let most = has.max_by(|a, b| (a.0.abs() / a.1).total_cmp(&(b.0.abs() / b.1)));
    let Some(((own, own_std), (size, size_std))) = beyond(flight).zip(most) else { return false };
    let is_there = size.abs() > TELLS * size_std;
    let is_less = own / size < SHOWN && (size - own).abs() > TELLS * own_std.hypot(size_std);
    is_there && is_less
}
