//! What each part of the flights alone says of a named effect: what is there in one part only is no property of the vehicle for certain.

use super::base::Base;
use super::explanation::{Explanation, Verdict};
use super::fit::{Fitted, Newton, fit};
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;
use rayon::prelude::*;
use std::ops::Range;

/// A part shows an effect by itself from this many standard errors on: the usual 95 %.
const SHOWN: f64 = 2.0;

/// The size of a named effect by each part alone: of one flight its halves, of several the flights.
#[derive(Debug, Clone, PartialEq)]
pub struct ByPart {
    /// of the effect
    pub id: &'static str,
    /// of its best known amount
    pub parameter: &'static str,
    /// SI
    pub unit: &'static str,
    /// value at which the effect is none
    pub nothing: f64,
    /// value and standard error, in the order of the parts
    pub parts: Vec<(f64, f64)>,
}

impl ByPart {
    /// Each part shows it by itself, in the same direction.
    #[must_use]
    pub fn is_in_each(&self) -> bool {
        let away = |(value, std): &(f64, f64)| if *std > 0.0 { (value - self.nothing) / std } else { 0.0 };
        let by = |sign: f64| self.parts.iter().all(|part| sign * away(part) >= SHOWN);
        by(1.0) || by(-1.0)
    }
}

/// Every named effect that acts all along the flights, by each part of these. An effect of one instant and a latency are not among them:
/// the one has its parts by its nature, and how surely the other is told is known.
///
/// # Errors
/// [`PhysicsError`] where a part cannot be fitted.
pub fn by_part(traces: &[Trace], explanation: &Explanation) -> Result<Vec<ByPart>, PhysicsError> {
    let after = &explanation.search.after;
    if explanation.verdict == Verdict::Unexplained {
        return Ok(Vec::new());
    }
    let is_asked = |term: &EffectTerm| {
        let is_named = explanation.named.iter().any(|named| named.id == term.id());
        is_named && term.signature.role.moment.is_none()
    };
    let asked: Vec<Amount> =
        (0..after.base.effects.len()).filter_map(|place| amount(after, place, is_asked)).collect();
    if asked.is_empty() {
        return Ok(Vec::new());
    }
    let parts: Vec<Trace> = match traces {
        [one] => [0..one.rows() / 2, one.rows() / 2..one.rows()].map(|rows| part_of(one, &rows)).into(),
        several => several.to_vec(),
    };
    let each = parts
        .par_iter()
        .map(|part| fit(std::slice::from_ref(part), after.base.clone(), Newton::Held))
        .collect::<Result<Vec<Fitted>, _>>()?;
    let one = |amount: &Amount| ByPart {
        id: amount.id,
        parameter: amount.parameter,
        unit: amount.unit,
        nothing: amount.nothing,
        parts: each.iter().map(|fitted| amount.of(fitted)).collect(),
    };
    Ok(asked.iter().map(one).collect())
}

/// These rows of a flight alone.
fn part_of(trace: &Trace, rows: &Range<usize>) -> Trace {
    let runs = trace.runs.iter().map(|run| run.start.max(rows.start)..run.end.min(rows.end));
    let runs = runs.filter(|run| !run.is_empty()).map(|run| run.start - rows.start..run.end - rows.start);
    let states = trace.states.iter().cloned().collect();
    let mut part = trace.reading(states, trace.specific_force_m_s2().cloned());
    (part.centers, part.runs) = (trace.centers[rows.clone()].to_vec(), runs.collect());
    // they are of all rows
    part.instruments = None;
    part
}

/// An amount of an effect of a base, and where it is.
struct Amount {
    id: &'static str,
    parameter: &'static str,
    unit: &'static str,
    nothing: f64,
    /// of the effect
    place: usize,
    slot: usize,
    /// among the free parameters of all effects
    column: usize,
}

impl Amount {
    /// Its value in a fit of the same base, and the standard error.
    fn of(&self, fitted: &Fitted) -> (f64, f64) {
        let value = fitted.base.effects[self.place].values[self.slot];
        (value, fitted.std_of(fitted.rows.nuisances.len() + self.column, (value, self.unit)))
    }
}

/// The best known amount of the effect in this place, if it is asked for.
fn amount(fitted: &Fitted, place: usize, is_asked: impl Fn(&EffectTerm) -> bool) -> Option<Amount> {
    let Base { effects, .. } = &fitted.base;
    let term = effects.get(place).filter(|term| is_asked(term))?;
    let first: usize = effects[..place].iter().map(|before| before.free.len()).sum();
    let free = term.free.iter().enumerate().filter(|(_, slot)| term.is_amount(**slot));
    let amounts = free.filter_map(|(index, &slot)| {
        let parameter = term.parameter(slot)?;
        let (name, unit) = (parameter.name, parameter.unit);
        let nothing = term.signature.nothing;
        Some(Amount { id: term.id(), parameter: name, unit, nothing, place, slot, column: first + index })
    });
    let away = |amount: &Amount| {
        let (value, std) = amount.of(fitted);
        (value - amount.nothing).abs() / std.max(f64::MIN_POSITIVE)
    };
    amounts.max_by(|a, b| away(a).total_cmp(&away(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(parts: &[(f64, f64)]) -> ByPart {
        ByPart { id: "x", parameter: "k", unit: "-", nothing: 1.0, parts: parts.to_vec() }
    }

    #[test]
    fn each_part_has_to_show_it_in_the_same_direction() {
        assert!(of(&[(0.9, 0.02), (0.8, 0.02)]).is_in_each());
        assert!(!of(&[(0.9, 0.02), (0.99, 0.02)]).is_in_each());
        assert!(!of(&[(0.9, 0.02), (1.1, 0.02)]).is_in_each());
        assert!(!of(&[(0.9, f64::NAN), (0.8, 0.02)]).is_in_each());
    }
}
