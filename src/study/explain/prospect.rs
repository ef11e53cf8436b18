//! Whether an explanation is certain, and how well its sizes are known.

use super::result::ExplainStudy;
use crate::diagnose::experiment::{NextFlight, Pair};
use crate::diagnose::{ByPart, Verdict, by_part, known_to};
use crate::note::{About, Note};

/// A size whose relative standard error (-) is not larger serves a simulator or a controller: no further flight is advised for it
/// alone. Set by judgement.
pub const WELL_KNOWN: f64 = 0.05;
/// A further flight has to leave at most this share of the whole error of a size. Set by judgement.
const LEFT: f64 = 0.8;
/// A latency that is so much longer than the stated lag, s, and so many standard errors, is told where it has no name. Only words
/// depend on both.
const TOLD_S: f64 = 0.02;
const TOLD_SIGMA: f64 = 4.0;

/// Whether the next flight lowers the relative standard error (-) of a size: only its statistical part becomes smaller, what the law of the
/// effect leaves open stays.
/// `amounts`: the distance from zero is that of so many parameters together, of which one has this error.
fn lowers(relative_std: f64, pair: &Pair, amounts: usize) -> bool {
    let own = ((amounts.max(1) as f64).sqrt() / pair.now).min(relative_std);
    let stays = (relative_std * relative_std - own * own).max(0.0).sqrt();
    stays.hypot(own * pair.share_left()) < LEFT * relative_std
}

impl ExplainStudy {
    /// No further flight is needed: nothing is left over, and no name could be another one's.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        let decided = matches!(self.verdict(), Verdict::NothingMissing | Verdict::Explained);
        decided
            && !self.explanation.too_little_excitation
            && self.doubts().is_empty()
            && self.limited().is_empty()
            && self.other_vehicle().is_none()
            && self.effects.iter().all(|effect| effect.confusable_with.is_empty())
            && self.unsettled().next().is_none()
    }

    /// What the designed flight separates or determines, of that which a user needs: names that could be another one's and are told
    /// apart with it, and sizes that are known worse than 5 %.
    pub fn worthwhile<'a>(&'a self, next: &'a NextFlight) -> impl Iterator<Item = &'a Pair> {
        next.pairs.iter().filter(|pair| match pair.other {
            Some(_) => pair.is_told_apart_by_next(),
            None => {
                let std = self.relative_std(pair);
                std > WELL_KNOWN && lowers(std, pair, self.amounts(pair))
            }
        })
    }

    /// A further flight was designed, and it would bring something that a user needs.
    #[must_use]
    pub fn would_gain(&self) -> bool {
        let Some(Ok(next)) = &self.next_flight else { return false };
        self.unsettled().next().is_some() || self.worthwhile(next).next().is_some()
    }

    /// Parameters of a named effect that have a unit.
    fn amounts(&self, pair: &Pair) -> usize {
        let named = self.effects.iter().find(|effect| effect.id == pair.named);
        named.map_or(1, |named| named.parameters.iter().filter(|of| of.unit != "-").count())
    }

    /// Of the size of a named effect; where none has a unit, of its distance from zero.
    fn relative_std(&self, pair: &Pair) -> f64 {
        let named = self.effects.iter().find(|effect| effect.id == pair.named);
        named.and_then(known_to).unwrap_or(1.0 / pair.now)
    }

    /// From command to rotor beyond the lag that the vehicle file states, and its standard error (s), where it is long and has no
    /// name.
    #[must_use]
    pub fn unnamed_latency_s(&self) -> Option<(f64, f64)> {
        let latency = self.latency();
        let stated_s = self.vehicle().propulsion.mean_time_constant_s().unwrap_or(0.0);
        let beyond_s = latency.total_s - stated_s;
        let is_told = latency.is_determined() && beyond_s > TOLD_S.max(TOLD_SIGMA * latency.std_s);
        (is_told && !self.latency_named()).then_some((beyond_s, latency.std_s))
    }

    /// Named effects that are not certain to be in each part of the flights.
    pub fn unsettled(&self) -> impl Iterator<Item = &ByPart> {
        self.by_part.iter().filter(|of| !of.is_certain())
    }

    /// Fits the named effects to each part of the flights.
    pub(super) fn tell_by_part(&mut self) {
        match by_part(&self.traces, &self.explanation) {
            Ok(found) => self.by_part = found,
            Err(error) => {
                let text = format!("whether each part of the flights shows the names: {error}");
                self.notes.push(Note::warning(About::Estimate, text));
            }
        }
    }
}
