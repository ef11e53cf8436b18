//! Of several flights, the models of all but one.

use super::result::ExplainStudy;
use crate::diagnose::{Explanation, rigid_by_flight};
use crate::estimate::NAMES;
use crate::signals::{OwnOfFlight, Signals};
use crate::study::Track;

/// For each flight the models, without and with effects, whose parameters the other flights tell. Which effects there are, and the
/// latency, is known from all of them.
pub(super) fn of_others(study: &ExplainStudy, flights: &[Signals]) -> Vec<Explanation> {
    let (vehicle, settings) = (&study.given.vehicle, &study.given.settings);
    let rigid = rigid_by_flight(flights, &study.explanation, vehicle, settings);
    let before = Track::all(rigid.into_iter().enumerate().collect(), flights.len(), vehicle);
    let after: &[Track] = study.along.as_ref().map_or(&[], |along| &along.tracks);
    let one = |flight: usize| {
        let [before, after] = [&before, after].map(|tracks| without(tracks, flight, flights));
        study.explanation.with_values(&before, &after)
    };
    (0..flights.len()).map(one).collect()
}

/// A named effect that one flight shows and no other: without that flight nothing tells its size.
pub(super) fn shown_only_by(study: &ExplainStudy, flight: usize, own: &OwnOfFlight) -> Option<&'static str> {
    if let Some((id, _)) = own.has.first() {
        return Some(id);
    }
    let carried = study.along.iter().flat_map(|along| &along.carried_by);
    carried.filter_map(|(id, by)| (by.as_deref()? == [flight]).then_some(*id)).next()
}

/// What the other flights have in common, by name, with its standard error.
fn without<'a>(tracks: &'a [Track], flight: usize, flights: &[Signals]) -> Vec<(&'a str, (f64, f64))> {
    let others = |track: &Track| {
        let mut track = track.clone();
        track.values[flight] = None;
        if track.effect.is_none() && track.name == NAMES[0] {
            // what they carry is their own, and by how much it is more rests on the others
            let unladen = flights.iter().map(|signals| signals.own.payload_kg == 0.0);
            let unladen: Vec<usize> = unladen
                .enumerate()
                .filter_map(|(at, unladen)| (unladen && at != flight).then_some(at))
                .collect();
            return if unladen.is_empty() {
                track.pooled()
            } else {
                track.only(&unladen).pooled().or_else(|| track.pooled())
            };
        }
        track.pooled()
    };
    tracks.iter().filter_map(|track| Some((track.name.as_str(), others(track)?))).collect()
}
