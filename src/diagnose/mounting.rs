//! Effects whose small sizes a nuisance models. They are tested only if nothing else passes, because almost any
//! constant force resembles a small tilt.

use super::candidates::instead_of_nuisances;
use super::evidence::Weighted;
use super::fit::Fitted;
use super::score::{columns_of, is_present};
use super::signature::Signature;
use super::tested::Tested;
use super::trace::Trace;
use rayon::prelude::*;

/// Each of these effects that the recordings can show, tested without its nuisance.
pub(super) fn mountings(
    flights: &[Trace],
    fitted: &Fitted,
    signatures: &[&'static Signature],
) -> Vec<Tested> {
    instead_of_nuisances(&fitted.base.vehicle, flights, signatures)
        .into_par_iter()
        .filter_map(|candidate| {
            if is_present(&fitted.base, &candidate) {
                return None;
            }
            let columns = columns_of(flights, fitted, &candidate)?;
            let stands_for = |nuisance| {
                candidate.parts.iter().any(|part| (part.signature.role.stands_for)(part, nuisance))
            };
            let rows = fitted.rows.without(stands_for);
            let evidence = Weighted::at(&rows, &fitted.weighted.sigma).test(&columns)?;
            Some(Tested { candidate, evidence })
        })
        .collect()
}
