//! Effects whose small sizes a nuisance stands for: tried only when nothing else passes, for almost any force that does
//! not change looks a little like a lean.

use super::candidates::instead_of_nuisances;
use super::evidence::Weighted;
use super::fit::Fitted;
use super::score::{columns_of, is_present};
use super::signature::Signature;
use super::tested::Tested;
use super::trace::Trace;
use rayon::prelude::*;

/// Each that the recordings show, tested without the nuisance that stands for it.
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
            let mut rows = fitted.rows.clone();
            let stands_for = |nuisance| {
                candidate.parts.iter().any(|part| (part.signature.role.stands_for)(part, nuisance))
            };
            rows.nuisances.retain(|column| !stands_for(column.nuisance));
            let evidence = Weighted::at(&rows, &fitted.weighted.sigma).test(&columns)?;
            Some(Tested { candidate, evidence })
        })
        .collect()
}
