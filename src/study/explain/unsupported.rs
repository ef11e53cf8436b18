//! Names of several flights that none of them supports.

use super::along_flights::AlongFlights;
use super::refuted::{BetterBy, Worthless};
use super::result::ExplainStudy;
use crate::diagnose::{NAME_Z, brief};

impl ExplainStudy {
    /// A named effect that no flight of several shows alone, and whose size from all of them together is less than a name needs. The evidence
    /// of a search over all flights is that of their residuals; the size is that of each flight's own fit, with all else that is its own.
    pub(super) fn unsupported(&self) -> Option<Worthless> {
        let along = self.along.as_ref()?;
        let named = self.explanation.named.iter().find(|named| is_of_none(along, named.id))?;
        let name = brief(named, &self.given.vehicle, true);
        Some(Worthless { id: named.id, name, better_percent: 0.0, by: BetterBy::NoFlight })
    }
}

fn is_of_none(along: &AlongFlights, id: &str) -> bool {
    let carriers =
        along.carried_by.iter().find(|(of, _)| *of == id).and_then(|(_, flights)| flights.as_ref());
    let is_small = |(size, std): (f64, f64)| size.abs() < NAME_Z * std;
    let mut sizes = along.tracks.iter().filter(|track| track.effect == Some(id)).filter_map(|track| {
        let (value, std) = along.together(track)?;
        Some((value - track.nothing, std))
    });
    let Some(first) = sizes.next() else { return false };
    carriers.is_some_and(Vec::is_empty) && is_small(first) && sizes.all(is_small)
}
