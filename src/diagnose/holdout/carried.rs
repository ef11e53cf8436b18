//! Transfer of the identified model to another flight.

use super::loading::{Loaded, has_other_mass, loaded, loaded_beside, without_payload};
use super::rate_law::RateLaw;
use super::settings::{Explained, HeldOut, HoldoutSettings};
use crate::diagnose::base::Base;
use crate::diagnose::empirical::Empirical;
use crate::diagnose::explanation::Verdict;
use crate::diagnose::latency_parts::{held_s, stated_lag_s, stated_uneven};
use crate::diagnose::recorded::Need;
use crate::diagnose::rows::Rows;
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::trace::Trace;
use crate::note::{About, Note};
use crate::physics::{ActuationLatency, PhysicsError};
use crate::text::significant;
use crate::vehicle::Vehicle;

/// The two models that are compared on one flight.
pub(super) struct Pair {
    pub(super) before: Base,
    pub(super) after: Base,
    /// with the flight's own centre of mass, where its beginning shows another one: what is predicted with
    pub(super) loaded: Option<LoadedPair>,
    /// the flight begins with another mass, and is predicted with that of the model
    pub(super) other_mass: bool,
    /// how the rates of both models move in open loop: it is no merit of the effects
    pub(super) rate_law: Option<RateLaw>,
    /// parameters that were not kept, as sentences
    pub(super) notes: Vec<Note>,
}

/// A pair with a flight's own centre of mass.
pub(super) struct LoadedPair {
    before: Base,
    after: Base,
    /// vehicle clock, s, up to where the flight was used for it
    until_s: f64,
}

impl Pair {
    /// The models for predictions, before and after.
    pub(super) fn predicting(&self) -> (&Base, &Base) {
        self.loaded.as_ref().map_or((&self.before, &self.after), |loaded| (&loaded.before, &loaded.after))
    }

    /// Takes the mass of an empirical term out of the better model.
    pub(super) fn take_out(&mut self, term: &Empirical) {
        self.after.vehicle.body.mass_kg -= term.mass_change_kg;
        if let Some(loaded) = &mut self.loaded {
            loaded.after.vehicle.body.mass_kg -= term.mass_change_kg;
        }
    }

    /// Takes back what no model file has: what the beginning of the flight shows of its own load. The same part of the flight is predicted.
    /// Returns whether there was any.
    pub(super) fn unload(&mut self, trace: &Trace) -> bool {
        let until_s = self.predicted_from_s();
        self.own(trace, until_s);
        until_s.is_finite()
    }

    /// Predicts with what a flight has its own.
    fn own(&mut self, trace: &Trace, until_s: f64) {
        if until_s.is_finite() || !trace.own.is_none() {
            let [before, after] = [&self.before, &self.after].map(|base| base.on(&trace.own).into_owned());
            self.loaded = Some(LoadedPair { before, after, until_s });
        }
    }

    /// Vehicle clock, s, from which on the flight is predicted.
    pub(super) fn predicted_from_s(&self) -> f64 {
        self.loaded.as_ref().map_or(f64::NEG_INFINITY, |loaded| loaded.until_s)
    }
}

/// The rigid body alone, and the model with its effects. A latency with a name is an effect: the rigid body alone then
/// has the stated motor and the log's sampling instead.
pub(super) fn pair(explained: Explained, vehicle: &Vehicle, trace: &Trace) -> Pair {
    let Explained { explanation, empirical, rate_law } = explained;
    let mut before = explanation.search.before.base.clone();
    if explanation.named.iter().any(|named| latency_kind(named.id).is_some()) {
        before.latency = ActuationLatency {
            delay_s: held_s(std::slice::from_ref(trace)),
            lag_s: stated_lag_s(vehicle),
            uneven: stated_uneven(vehicle),
        };
    }
    let mut after = explanation.search.after.base.clone();
    if explanation.verdict == Verdict::Unexplained {
        // nothing was named, so nothing named may help
        after = before.clone();
    }
    if let Some(term) = empirical {
        after.vehicle.body.mass_kg += term.mass_change_kg;
    }
    Pair { before, after, loaded: None, other_mass: false, rate_law, notes: Vec::new() }
}

/// The pair on a flight that was explained, with what is its own.
pub(super) fn pair_on(explained: Explained, vehicle: &Vehicle, trace: &Trace) -> Pair {
    let mut pair = pair(explained, vehicle, trace);
    pair.own(trace, f64::NEG_INFINITY);
    pair
}

/// The pair for a hold-out flight. Parameters that belong to the day or to a time are estimated again or reported.
pub(super) fn carried_over(
    explained: Explained,
    (flight, trace): (&HeldOut, &Trace),
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<Pair, PhysicsError> {
    let about = || About::File(flight.name.to_owned());
    let mut pair = pair(explained, vehicle, trace);
    let moment = pair.after.effects.iter().enumerate().find_map(|(place, term)| {
        Some((place, term.signature.role.moment?, *term.signature.amounts.first()?))
    });
    // in another part of the same flight the moment is known
    if let Some((place, slot, amount)) = moment.filter(|_| !settings.same_flight) {
        let kept_kg = pair.after.effects[place].values[amount];
        let time_s = change_time(&pair.after, (place, slot), trace)?;
        pair.after.effects[place].values[slot] = time_s.unwrap_or(NEVER_S);
        let when = time_s.map_or("nowhere in this flight".to_owned(), |t| format!("at {t:.1} s"));
        let text = format!(
            "the moment of the mass change was found again {when}; its size, {kept_kg:+.3} kg, was kept"
        );
        pair.notes.push(Note::remark(about(), text));
    }
    let has = |what: fn(&EffectTerm) -> bool| pair.after.effects.iter().any(what);
    let of_the_day = has(|term| term.signature.role.of_the_day);
    let by_voltage = has(|term| term.signature.needs.contains(&Need::Voltage));
    if of_the_day && !(settings.same_flight || settings.own_wind) {
        pair.notes.push(Note::warning(
            about(),
            "predicted with the wind of the identification flights; another day's wind would show as a difference in the table of \
             parameters",
        ));
    }
    if by_voltage && trace.voltage_v.is_none() {
        let text = "the battery's voltage is not recorded, so its sag is left out";
        pair.notes.push(Note::warning(about(), text));
    }
    pair.other_mass = !settings.same_flight && !settings.own_mass && has_other_mass(&pair.after, trace)?;
    pair.own(trace, f64::NEG_INFINITY);
    if let Some(after) = loaded(&pair.after, trace, settings)? {
        pair.notes.push(Note::warning(about(), of_load(&after)));
        let beside = if after.more_kg.is_some() { loaded_beside } else { loaded };
        let before = beside(&pair.before, trace, settings)?
            .map_or_else(|| pair.before.on(&without_payload(trace)).into_owned(), |of| of.base);
        pair.loaded = Some(LoadedPair { before, after: after.base, until_s: after.until_s });
    }
    Ok(pair)
}

/// What a flight's load is, in words.
fn of_load(load: &Loaded) -> String {
    let mut own = Vec::new();
    own.extend(load.moved_m.map(|[x, y]| {
        format!(
            "its centre of mass is not where that of the flights explained is: by ({}, {}) mm along body x and y, as a battery that is \
             put back elsewhere moves it",
            significant(1e3 * x, 2),
            significant(1e3 * y, 2)
        )
    }));
    own.extend(load.more_kg.map(|kg| {
        format!(
            "its mass by the thrust differs from that of the flights that predict it by {} kg: a payload, or another battery",
            significant(kg, 2)
        )
    }));
    format!(
        "{}. This is from the first seconds of the flight, and the errors are those of the rest",
        own.join("; ")
    )
}

/// A time that no flight reaches, s.
const NEVER_S: f64 = 1e5;

/// The time (s) from which the changed mass explains the force along body z better than the first one; `None` if there
/// is none.
fn change_time(
    after: &Base,
    (place, slot): (usize, usize),
    trace: &Trace,
) -> Result<Option<f64>, PhysicsError> {
    let with_time = |time_s: f64| {
        let mut base = after.clone();
        base.effects[place].values[slot] = time_s;
        Rows::new(std::slice::from_ref(trace), &base)
    };
    let (unchanged, changed) = (with_time(NEVER_S)?, with_time(0.0)?);
    // cost of a change after row k: squares of the first mass up to k, of the second from there
    let gains: Vec<f64> = unchanged.residual[2]
        .iter()
        .zip(&changed.residual[2])
        .map(|(first, second)| first * first - second * second)
        .collect();
    let (mut best, mut most, mut sum) = (None, 0.0, 0.0);
    for (row, gain) in gains.iter().enumerate().rev() {
        sum += gain;
        if sum > most {
            (most, best) = (sum, Some(unchanged.time_s[row]));
        }
    }
    Ok(best)
}
