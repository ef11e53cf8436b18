//! Of several flights, the models of all but one.

use super::result::ExplainStudy;
use crate::diagnose::{Explanation, rigid_by_flight};
use crate::signals::Signals;
use crate::study::Track;

/// For each flight the models, without and with effects, whose parameters the other flights tell. Which effects there are, and the
/// latency, is known from all of them.
pub(super) fn of_others(study: &ExplainStudy, flights: &[Signals]) -> Vec<Explanation> {
    let (vehicle, settings) = (&study.given.vehicle, &study.given.settings);
    let rigid = rigid_by_flight(flights, &study.explanation, vehicle, settings);
    let before = Track::all(rigid.into_iter().enumerate().collect(), flights.len(), vehicle);
    let after: &[Track] = study.along.as_ref().map_or(&[], |along| &along.tracks);
    let one = |flight: usize| {
        let [before, after] = [&before, after].map(|tracks| without(tracks, flight));
        study.explanation.with_values(&before, &after)
    };
    (0..flights.len()).map(one).collect()
}

/// A named effect that one flight shows and no other: without that flight nothing tells its size.
pub(super) fn shown_only_by(study: &ExplainStudy, flight: usize) -> Option<&'static str> {
    let carried = study.along.iter().flat_map(|along| &along.carried_by);
    carried.filter_map(|(id, by)| (by.as_deref()? == [flight]).then_some(*id)).next()
}

/// What the other flights have in common, by name, with its standard error.
fn without(tracks: &[Track], flight: usize) -> Vec<(&str, (f64, f64))> {
    let others = |track: &Track| {
        let mut track = track.clone();
        track.values[flight] = None;
        track.pooled()
    };
    tracks.iter().filter_map(|track| Some((track.name.as_str(), others(track)?))).collect()
}
