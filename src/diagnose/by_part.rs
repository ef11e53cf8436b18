//! What each part of the flights alone says of a named effect: what is there in one part only is no property of the vehicle for certain.

use super::base::Base;
use super::explanation::{Explanation, Verdict};
use super::fit::{Fitted, Newton, fit};
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::ops::Range;

/// A part shows an effect by itself from this many standard errors on: the usual 95 %.
const SHOWN: f64 = 2.0;
/// Standard errors from which on all parts together show one amount of an effect: as many as it needs to stay in a model. A name asks more
/// of all its amounts together.
const SHOWN_BY_ALL: f64 = 3.0;
/// Chance of parts that differ as much where each shows the same, below which they differ. One true effect of a hundred is not certain
/// by it; with a twentieth it would be five.
const ALIKE_P: f64 = 0.01;

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
    /// value and standard error by all parts together
    pub whole: (f64, f64),
    /// value and standard error, in the order of the parts
    pub parts: Vec<(f64, f64)>,
}

impl ByPart {
    /// All parts together show it, and it is in each: their sizes agree within their errors (a chi square of their differences), or
    /// each part shows it by itself, in the same direction.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        // the error of the whole has guesses of the vehicle's description, which are no question of whether it is there
        let by_all = self.away(&self.whole).abs().max(self.away(&self.mean()).abs());
        by_all >= SHOWN_BY_ALL && (self.are_alike() || self.is_in_each())
    }

    /// Mean of the parts, weighted by their information, with its standard error; NaN where one has no error.
    fn mean(&self) -> (f64, f64) {
        let (mut weights, mut sum) = (0.0, 0.0);
        for (value, std) in &self.parts {
            // one without an error says nothing
            let weight = if *std > 0.0 { std.powi(-2) } else { f64::NAN };
            (weights, sum) = (weights + weight, sum + weight * value);
        }
        (sum / weights, weights.sqrt().recip())
    }

    /// Standard errors from nothing; 0 where there is no error.
    fn away(&self, (value, std): &(f64, f64)) -> f64 {
        if *std > 0.0 { (value - self.nothing) / std } else { 0.0 }
    }

    /// Each part shows it by itself, in the same direction.
    #[must_use]
    pub fn is_in_each(&self) -> bool {
        self.is_in_each_by(SHOWN)
    }

    /// The same by so many standard errors.
    pub(crate) fn is_in_each_by(&self, least: f64) -> bool {
        let by = |sign: f64| self.parts.iter().all(|part| sign * self.away(part) >= least);
        by(1.0) || by(-1.0)
    }

    /// Whether a value with its standard error, of another flight, is none within so many standard errors or less than a third of the whole, and
    /// differs from the whole by as many.
    pub(crate) fn lacks(&self, other: &(f64, f64), sigmas: f64) -> bool {
        let apart = (other.0 - self.whole.0).abs();
        let most = (sigmas * other.1).max((self.whole.0 - self.nothing).abs() / 3.0);
        (other.0 - self.nothing).abs() < most && apart >= sigmas * other.1.hypot(self.whole.1)
    }

    /// Whether the parts' sizes scatter no more than their errors let them.
    #[must_use]
    pub fn are_alike(&self) -> bool {
        let (mean, _) = self.mean();
        let statistic: f64 = self.parts.iter().map(|(value, std)| ((value - mean) / std).powi(2)).sum();
        let free = self.parts.len().saturating_sub(1) as f64;
        ChiSquared::new(free).is_ok_and(|law| law.sf(statistic) >= ALIKE_P)
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
    // a part that lies on one side of a moment does not tell what changed then from the mass
    let mut base = after.base.clone();
    let of_moment = base.effects.iter_mut().filter(|term| term.signature.role.moment.is_some());
    of_moment.for_each(|term| term.free.clear());
    let each = parts
        .par_iter()
        .map(|part| fit(std::slice::from_ref(part), base.clone(), Newton::Held))
        .collect::<Result<Vec<Fitted>, _>>()?;
    let one = |amount: &Amount| ByPart {
        id: amount.id,
        parameter: amount.parameter,
        unit: amount.unit,
        nothing: amount.nothing,
        whole: amount.of(after),
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
    /// among the free parameters of the effect
    index: usize,
}

impl Amount {
    /// Its value in a fit of the same base, and the standard error.
    fn of(&self, fitted: &Fitted) -> (f64, f64) {
        let effects = &fitted.base.effects;
        let before: usize = effects[..self.place].iter().map(|term| term.free.len()).sum();
        let value = effects[self.place].values[self.slot];
        (value, fitted.std_of(fitted.rows.nuisances.len() + before + self.index, (value, self.unit)))
    }
}

/// The best known amount of the effect in this place, if it is asked for.
fn amount(fitted: &Fitted, place: usize, is_asked: impl Fn(&EffectTerm) -> bool) -> Option<Amount> {
    let Base { effects, .. } = &fitted.base;
    let term = effects.get(place).filter(|term| is_asked(term))?;
    let free = term.free.iter().enumerate().filter(|(_, slot)| term.is_amount(**slot));
    let amounts = free.filter_map(|(index, &slot)| {
        let parameter = term.parameter(slot)?;
        let (name, unit) = (parameter.name, parameter.unit);
        let nothing = term.signature.nothing;
        Some(Amount { id: term.id(), parameter: name, unit, nothing, place, slot, index })
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

    use statrs::distribution::Normal;

    /// By parts of equal lengths.
    fn of(parts: &[(f64, f64)]) -> ByPart {
        let count = parts.len() as f64;
        let mean = parts.iter().map(|(value, _)| value).sum::<f64>() / count;
        let std = parts.iter().map(|(_, std)| std * std).sum::<f64>().sqrt() / count;
        ByPart { id: "x", parameter: "k", unit: "-", nothing: 1.0, whole: (mean, std), parts: parts.to_vec() }
    }

    #[test]
    fn parts_agree_or_show_it_each_by_itself() {
        assert!(of(&[(0.9, 0.02), (0.8, 0.02)]).is_certain());
        // one half shows little of it by itself, and no less than its error lets it
        assert!(of(&[(0.9, 0.03), (0.95, 0.03)]).is_certain());
        assert!(!of(&[(0.9, 0.02), (0.99, 0.02)]).is_certain());
        assert!(!of(&[(0.9, 0.02), (1.1, 0.02)]).is_certain());
        assert!(!of(&[(0.9, f64::NAN), (0.8, 0.02)]).is_certain());
        // alike, and nothing for certain
        assert!(!of(&[(0.97, 0.02), (0.98, 0.02)]).is_certain());
    }

    #[test]
    fn another_flight_lacks_what_it_does_not_show() {
        let whole = of(&[(0.85, 0.003), (0.86, 0.003)]);
        assert!(whole.is_in_each_by(8.0) && !whole.is_in_each_by(60.0));
        // as much as rotors scatter by
        assert!(whole.lacks(&(0.99, 0.001), 4.0));
        assert!(!whole.lacks(&(0.92, 0.003), 4.0));
        // a flight that tells nothing
        assert!(!whole.lacks(&(0.97, 0.06), 4.0));
    }

    /// Halves with every chance of their errors that is equally likely, of those whose whole has a name's four standard errors:
    /// shares that are certain now, and where each half had to show two.
    fn shares(first: f64, second: f64) -> (f64, f64) {
        const STEPS: u32 = 200;
        let law = Normal::standard();
        let normal = |step: u32| law.inverse_cdf((f64::from(step) + 0.5) / f64::from(STEPS));
        let (mut named, mut certain, mut in_each) = (0, 0, 0);
        for one in 0..STEPS {
            for other in 0..STEPS {
                let found = of(&[(1.0 + first + normal(one), 1.0), (1.0 + second + normal(other), 1.0)]);
                if found.away(&found.whole) >= 4.0 {
                    named += 1;
                    certain += u32::from(found.is_certain());
                    in_each += u32::from(found.is_in_each());
                }
            }
        }
        (f64::from(certain) / f64::from(named), f64::from(in_each) / f64::from(named))
    }

    #[test]
    fn an_effect_that_is_there_all_along_is_certain_and_one_of_a_half_is_not() {
        // four standard errors of the whole are 2.8 of a half
        let (certain, in_each) = shares(2.83, 2.83);
        assert!(certain > 0.985 && in_each < 0.92, "{certain}, {in_each}");
        let (certain, _) = shares(8.0, 0.0);
        assert!(certain < 0.05, "{certain}");
    }

    #[test]
    fn halves_show_an_effect_each_by_itself_and_alike() {
        let of = |parts: [(f64, f64); 2]| ByPart {
            id: "inflow",
            parameter: "kz",
            unit: "N/(m/s)",
            nothing: 0.0,
            whole: (0.5, 0.05),
            parts: parts.to_vec(),
        };
        let shown = |parts| (of(parts).is_in_each(), of(parts).are_alike());
        assert_eq!(shown([(0.5, 0.1), (0.45, 0.1)]), (true, true));
        assert_eq!(shown([(0.5, 0.1), (0.1, 0.1)]), (false, false));
        assert_eq!(shown([(0.5, 0.05), (0.2, 0.05)]), (true, false));
        assert_eq!(shown([(0.3, 0.1), (0.1, 0.1)]), (false, true));
        assert_eq!(shown([(0.5, 0.1), (-0.5, 0.1)]), (false, false));
    }
}
