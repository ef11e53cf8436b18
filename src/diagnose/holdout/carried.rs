//! Transfer of the identified model to another flight.

use super::settings::{HeldOut, HoldoutSettings};
use crate::diagnose::base::Base;
use crate::diagnose::empirical::Empirical;
use crate::diagnose::explanation::{Explanation, Verdict};
use crate::diagnose::latency::{stated_lag_s, stated_uneven};
use crate::diagnose::recorded::Need;
use crate::diagnose::rows::Rows;
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::trace::Trace;
use crate::physics::{ActuationLatency, PhysicsError};
use crate::vehicle::Vehicle;

/// The two models that are compared on one flight.
pub(super) struct Pair {
    pub(super) before: Base,
    pub(super) after: Base,
    /// parameters that were not kept, as sentences
    pub(super) notes: Vec<String>,
}

/// The rigid body alone, and the model with its effects. A latency with a name is an effect: the rigid body alone then
/// has the stated motor and the log's sampling instead.
pub(super) fn pair(
    (explanation, empirical): (&Explanation, Option<&Empirical>),
    vehicle: &Vehicle,
    command_period_s: f64,
) -> Pair {
    let mut before = explanation.search.before.base.clone();
    if explanation.named.iter().any(|named| latency_kind(named.id).is_some()) {
        before.latency = ActuationLatency {
            delay_s: 0.5 * command_period_s,
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
    Pair { before, after, notes: Vec::new() }
}

/// The pair for a hold-out flight. Parameters that belong to the day or to a time are estimated again or reported.
pub(super) fn carried_over(
    explained: (&Explanation, Option<&Empirical>),
    (flight, trace): (&HeldOut, &Trace),
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<Pair, PhysicsError> {
    let mut pair = pair(explained, vehicle, trace.command_period_s);
    let moment = pair.after.present.iter().enumerate().find_map(|(place, term)| {
        Some((place, term.signature.role.moment?, *term.signature.amounts.first()?))
    });
    // in another part of the same flight the moment is known
    if let Some((place, slot, amount)) = moment.filter(|_| !settings.same_flight) {
        let kept_kg = pair.after.present[place].values[amount];
        let time_s = change_time(&pair.after, (place, slot), trace)?;
        pair.after.present[place].values[slot] = time_s.unwrap_or(NEVER_S);
        let when = time_s.map_or("nowhere in this flight".to_owned(), |t| format!("at {t:.1} s"));
        pair.notes.push(format!(
            "{}: the moment of the mass change was found again {when}; its size, {kept_kg:+.3} kg, was kept",
            flight.name
        ));
    }
    let has = |what: fn(&EffectTerm) -> bool| pair.after.present.iter().any(what);
    let of_the_day = has(|term| term.signature.role.of_the_day);
    let by_voltage = has(|term| term.signature.needs.contains(&Need::Voltage));
    if of_the_day && !settings.same_flight {
        pair.notes.push(format!(
            "{}: predicted with the wind of the identification flights; another day's wind would show as a difference in the table of parameters",
            flight.name
        ));
    }
    if by_voltage && trace.voltage_v.is_none() {
        pair.notes
            .push(format!("{}: the battery's voltage is not recorded, so its sag is left out", flight.name));
    }
    Ok(pair)
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
        base.present[place].values[slot] = time_s;
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
