//! Which other effect could stand for a named one in this flight.

use super::evidence::Weighted;
use super::explanation::Confusable;
use super::search::{Fitted, Tested};
use super::trace::Trace;

/// Effects closer than this many standard deviations are not told apart.
const APART: f64 = 5.0;

/// Distance, in standard deviations, between what the effect at `place` does and the nearest that another
/// candidate could do in its stead; those below [`APART`].
#[must_use]
pub fn confusable_with(
    flights: &[Trace],
    fitted: &Fitted,
    place: usize,
    others: &[Tested],
) -> Vec<Confusable> {
    let present = &fitted.base.present;
    let before: usize = present[..place].iter().map(|p| p.free.len()).sum();
    let own = before..before + present[place].free.len();
    let mut rows = fitted.rows.clone();
    let columns: Vec<_> = rows.effects.drain(own).collect();
    let effect = &present[place];
    let values: Vec<f64> =
        effect.free.iter().map(|&slot| effect.values[slot] - effect.nothing_at(slot)).collect();
    let weighted = Weighted::new(&rows);
    let Some((_, partialled)) = weighted.partialled(&columns) else { return Vec::new() };
    let mut signal = nalgebra::DVector::zeros(partialled.nrows());
    for (index, value) in values.iter().enumerate() {
        signal += partialled.column(index) * *value;
    }
    let inflation = fitted.weighted.long_run_deviation();
    let mut out: Vec<Confusable> = Vec::new();
    for other in others {
        let id = other.candidate.id;
        if id == present[place].effect.id() || other.candidate.through.is_some() {
            continue;
        }
        let mut columns = Vec::new();
        for part in &other.candidate.parts {
            if let Ok(found) = fitted.rows.columns_of(flights, &fitted.base, part) {
                columns.extend(found);
            }
        }
        let Some((_, basis)) = weighted.partialled(&columns) else { continue };
        let left = left_over(&signal, &basis);
        let distance = left / inflation;
        if distance < APART {
            let known = out.iter_mut().find(|confusable| confusable.id == id);
            match known {
                Some(known) => {
                    known.distinguishability = known.distinguishability.map(|d| d.min(distance));
                }
                None => out.push(Confusable { id, distinguishability: Some(distance) }),
            }
        }
    }
    out
}

/// Norm of what the columns cannot make of the signal.
fn left_over(signal: &nalgebra::DVector<f64>, basis: &nalgebra::DMatrix<f64>) -> f64 {
    let normal = basis.tr_mul(basis);
    let Some(factor) = normal.cholesky() else { return signal.norm() };
    let theta = factor.solve(&basis.tr_mul(signal));
    (signal - basis * theta).norm()
}
