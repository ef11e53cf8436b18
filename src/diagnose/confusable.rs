//! Effects that this flight does not distinguish from a named effect.

use super::base::Base;
use super::candidates::Candidate;
use super::channels::{CHANNELS, Channels};
use super::evidence::Weighted;
use super::fit::Fitted;
use super::named::Confusable;
use super::rows::Rows;
use super::score::at_once;
use super::tested::Tested;
use super::told_apart::APART;
use super::trace::Trace;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// An effect of which another leaves more than this share of its norm is not similar to it, however weak it is:
/// sqrt(3)/2, a cosine of one half. Only the list of confusable effects depends on it.
const UNLIKE: f64 = 0.866;

/// Distance, in standard deviations, between the effect at `place` and the most similar contribution of another
/// candidate, for those below [`APART`]; and the similar ones among `rivals`, which explained as much.
#[must_use]
pub fn confusable_with(
    flights: &[Trace],
    fitted: &Fitted,
    place: usize,
    (others, rivals): (&[Tested], &[&Tested]),
) -> Vec<Confusable> {
    let mut out: Vec<Confusable> = Vec::new();
    let Some(signal) = Signal::new(&fitted.rows, &fitted.base, place, None) else { return out };
    let inflation = fitted.weighted.long_run_deviation();
    let beyond = |candidate: &Candidate| signal.beyond(flights, &fitted.rows, &fitted.base, candidate);
    let left: Vec<Option<f64>> = others
        .par_chunks(at_once(fitted))
        .flat_map_iter(|some| {
            let candidates: Vec<&Candidate> = some.iter().map(|other| &other.candidate).collect();
            signal.beyond_each(flights, &fitted.rows, &fitted.base, &candidates)
        })
        .collect();
    for (other, left) in others.iter().zip(left) {
        let Some(left) = left else { continue };
        let (id, distance) = (other.candidate.id, left / inflation);
        if distance < APART && left < UNLIKE * signal.norm() {
            let known = out.iter_mut().find(|confusable| confusable.id == id);
            match known {
                Some(known) => {
                    known.distinguishability = known.distinguishability.map(|d| d.min(distance));
                }
                None => out.push(Confusable { id, distinguishability: Some(distance) }),
            }
        }
    }
    // a rival that explained as much stays one, with its distance, even where the fit distinguishes them
    for rival in rivals {
        let id = rival.candidate.id;
        let alike = beyond(&rival.candidate).filter(|left| *left < UNLIKE * signal.norm());
        if let Some(left) = alike.filter(|_| out.iter().all(|confusable| confusable.id != id)) {
            out.push(Confusable { id, distinguishability: Some(left / inflation) });
        }
    }
    out
}

/// Contribution of one of a base's effects to its rows, without the part that nuisances and the other effects explain.
pub(super) struct Signal {
    id: &'static str,
    weighted: Weighted,
    sum: DVector<f64>,
}

impl Signal {
    /// The contribution of the effect at `place`, in standard deviations of each channel: those of the rows, or the
    /// given ones (N, N m). `None` if it cannot be distinguished from the nuisances.
    pub(super) fn new(
        rows: &Rows,
        base: &Base,
        place: usize,
        sigma: Option<&[f64; CHANNELS]>,
    ) -> Option<Self> {
        let effect = base.effects.get(place)?;
        let before: usize = base.effects[..place].iter().map(|p| p.free.len()).sum();
        let mut rows = rows.clone();
        let columns: Vec<_> = rows.effects.drain(before..before + effect.free.len()).collect();
        let weighted = sigma.map_or_else(|| Weighted::new(&rows), |sigma| Weighted::at(&rows, sigma));
        let (_, partialled) = weighted.partialled(&columns)?;
        let mut sum = DVector::zeros(partialled.nrows());
        // what the effect is like changes with how much of it there is, and adds nothing to it
        let amounts = effect.free.iter().enumerate().filter(|(_, slot)| effect.is_amount(**slot));
        for (index, &slot) in amounts {
            sum += partialled.column(index) * effect.from_nothing(slot);
        }
        Some(Self { id: effect.id(), weighted, sum })
    }

    /// Norm of the contribution, in standard deviations of independent rows.
    pub(super) fn norm(&self) -> f64 {
        self.sum.norm()
    }

    /// Norm of the part that a candidate cannot explain, in standard deviations of independent rows. `None` for the
    /// effect itself, and for a candidate without influence.
    pub(super) fn beyond(
        &self,
        flights: &[Trace],
        rows: &Rows,
        base: &Base,
        candidate: &Candidate,
    ) -> Option<f64> {
        if candidate.id == self.id {
            return None;
        }
        let mut columns = Vec::new();
        for (index, part) in candidate.parts.iter().enumerate() {
            let found = match &candidate.through {
                // the last part acts through this one, as far as it is there
                Some(unit) if index + 1 == candidate.parts.len() => {
                    let mut with_unit = base.clone();
                    with_unit.effects.push(unit.clone());
                    rows.columns_through(flights, &with_unit, part)
                }
                // and what is named already is not its own rival
                Some(_) if part.id() == self.id => continue,
                _ => rows.columns_of(flights, base, part),
            };
            columns.extend(found.into_iter().flatten());
        }
        self.beyond_columns(&columns)
    }

    /// The same of several candidates.
    fn beyond_each(
        &self,
        flights: &[Trace],
        rows: &Rows,
        base: &Base,
        candidates: &[&Candidate],
    ) -> Vec<Option<f64>> {
        let is_plain = |candidate: &&&Candidate| {
            candidate.id != self.id && candidate.through.is_none() && candidate.parts.len() == 1
        };
        let parts: Vec<_> =
            candidates.iter().filter(is_plain).flat_map(|candidate| &candidate.parts).collect();
        let mut plain = rows.columns_of_each(flights, base, &parts).into_iter();
        let of = |candidate: &&Candidate| match Some(candidate).filter(is_plain).and_then(|_| plain.next()) {
            Some(columns) => self.beyond_columns(&columns.unwrap_or_default()),
            None => self.beyond(flights, rows, base, candidate),
        };
        candidates.iter().map(of).collect()
    }

    fn beyond_columns(&self, columns: &[Channels]) -> Option<f64> {
        let (_, basis) = self.weighted.partialled(columns)?;
        Some(left_over(&self.sum, &basis))
    }
}

/// Norm of the part of the signal that the columns do not explain.
fn left_over(signal: &DVector<f64>, basis: &DMatrix<f64>) -> f64 {
    let normal = basis.tr_mul(basis);
    let Some(factor) = normal.cholesky() else { return signal.norm() };
    let theta = factor.solve(&basis.tr_mul(signal));
    (signal - basis * theta).norm()
}
