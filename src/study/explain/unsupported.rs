//! Names of several flights that none of them supports.

use super::along_flights::AlongFlights;
use super::refuted::{BetterBy, Worthless};
use super::result::ExplainStudy;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{NAME_Z, brief};
use crate::study::Track;
use crate::study::track::CARRIES;

impl ExplainStudy {
    /// A named effect that no single flight shows, and whose size from all of them together is less than a name needs. The evidence of a
    /// search over all flights is that of their residuals; the size is that of each flight's own fit, with all else that is its own. What all
    /// flights' errors have in common, such as a guess, says nothing against the effect. A lag, a delay and the moment of a change are not
    /// judged so.
    pub(super) fn unsupported(&self) -> Option<Worthless> {
        let along = self.along.as_ref()?;
        let is_judged = |id: &str| {
            let by_columns =
                signature_of(id).is_some_and(|of| of.role.latency.is_none() && of.role.moment.is_none());
            by_columns && !self.given.settings.refused.contains(&id)
        };
        let mut named = self.explanation.named.iter();
        let named = named.find(|named| is_judged(named.id) && is_of_none(along, named.id))?;
        let name = brief(named, &self.given.vehicle, true);
        Some(Worthless { id: named.id, name, better_percent: 0.0, by: BetterBy::NoFlight })
    }
}

/// Whether no flight shows an effect, and all of them together less of it than a name needs: the squares of its parameters' deviations from
/// none, each over its standard error, are summed.
fn is_of_none(along: &AlongFlights, id: &str) -> bool {
    let carriers =
        along.carried_by.iter().find(|(of, _)| *of == id).and_then(|(_, flights)| flights.as_ref());
    let tracks =
        || along.tracks.iter().filter(|track| track.effect == Some(id) && along.together(track).is_some());
    let is_shown = |track: &Track| deviations(track).any(|z| z.abs() >= CARRIES);
    let together: f64 = tracks().map(|track| pooled(track).powi(2)).sum();
    carriers.is_some_and(Vec::is_empty)
        && tracks().next().is_some()
        && !tracks().any(is_shown)
        && together < NAME_Z * NAME_Z
}

/// Each flight's deviation from none and its standard error, without what the errors of all flights have in common.
fn own(track: &Track) -> impl Iterator<Item = (f64, f64)> {
    let common = track.common_std.iter().copied().chain(std::iter::repeat(0.0));
    track.values.iter().zip(common).filter_map(|(value, common)| {
        let (value, std) = (*value)?;
        Some((value - track.nothing, (std * std - common * common).max(0.0).sqrt().max(f64::MIN_POSITIVE)))
    })
}

fn deviations(track: &Track) -> impl Iterator<Item = f64> {
    own(track).map(|(by, std)| by / std)
}

/// The deviation of the flights' mean, over its standard error.
fn pooled(track: &Track) -> f64 {
    let (sum, weights) = own(track).fold((0.0, 0.0), |(sum, weights), (by, std)| {
        let weight = (std * std).max(f64::MIN_POSITIVE).recip();
        (sum + weight * by, weights + weight)
    });
    if weights > 0.0 { sum / weights.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Owner;

    /// Three flights of a drag, N/(m/s), with an error of which a part is common to all.
    fn along(values: [f64; 3], std: f64, common: f64) -> AlongFlights {
        let values = values.map(|value| Some((value, std))).to_vec();
        let track = Track::stored(
            ("linear_drag.dx", "N/(m/s)"),
            (Owner::Vehicle, Some("linear_drag")),
            values,
            vec![common; 3],
        );
        AlongFlights {
            tracks: vec![track.expect("a unit of an effect")],
            winds_m_s: Vec::new(),
            carried_by: vec![("linear_drag", Some(Vec::new()))],
            sized_by: Vec::new(),
            of_one_flight: Vec::new(),
            alone: Vec::new(),
        }
    }

    #[test]
    fn a_size_of_three_errors_that_no_flight_shows_is_of_none() {
        assert!(is_of_none(&along([0.02, 0.02, 0.02], 0.011, 0.0), "linear_drag"));
        // together it is there, in one flight it is there, and what is guessed alike for all says nothing
        assert!(!is_of_none(&along([0.03, 0.03, 0.03], 0.0115, 0.0), "linear_drag"));
        assert!(!is_of_none(&along([0.04, 0.0, 0.0], 0.011, 0.0), "linear_drag"));
        assert!(!is_of_none(&along([0.02, 0.02, 0.02], 0.011, 0.0105), "linear_drag"));
        assert!(!is_of_none(&along([0.02, 0.02, 0.02], 0.011, 0.0), "inflow"));
    }
}
