//! Several flights: what they have in common, what is each one's own, and which flights carry a name.

use super::along_flights::AlongFlights;
use super::result::ExplainStudy;
use crate::diagnose::{ExplainSettings, each_with_model_of_all, own_wind, relative_to_air};
use crate::signals::Signals;
use crate::study::Track;
use crate::study::flights::Prepared;
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use rayon::prelude::*;

/// Each flight as seen with its own wind, and these winds.
pub(super) fn with_own_winds(flights: &mut Prepared, vehicle: &Vehicle) -> Vec<Option<[f64; 2]>> {
    let settings = ExplainSettings::default();
    let found: Vec<Option<Vector3<f64>>> =
        flights.signals.par_iter().map(|signals| own_wind(signals, vehicle, &settings)).collect();
    for (signals, wind) in flights.signals.iter_mut().zip(&found) {
        if let Some(wind) = wind {
            *signals = relative_to_air(signals, wind);
        }
    }
    flights.drift = found.iter().map(Option::is_some).collect();
    found.into_iter().map(|wind| wind.map(|wind| [wind.x, wind.y])).collect()
}

impl ExplainStudy {
    /// Fits each flight alone to the model of all.
    pub(super) fn tell_along(&mut self, flights: &[Signals], mut winds_m_s: Vec<Option<[f64; 2]>>) {
        let (vehicle, settings) = (&self.given.vehicle, &self.given.settings);
        let drifts: Vec<bool> = winds_m_s.iter().map(Option::is_some).collect();
        let each = each_with_model_of_all(flights, &drifts, &self.explanation, (vehicle, settings));
        let mut tracks = Track::all(each.into_iter().enumerate().collect(), flights.len());
        if drifts.iter().any(|drifts| *drifts) {
            // what was left of a wind belongs to it
            for (track, axis) in tracks.iter().filter_map(|track| Some((track, track.wind_axis?))) {
                for (wind, left) in winds_m_s.iter_mut().zip(&track.values) {
                    if let (Some(part), Some((left, _))) =
                        (wind.as_mut().and_then(|wind| wind.get_mut(axis)), left)
                    {
                        *part += left;
                    }
                }
            }
            tracks.retain(|track| track.wind_axis.is_none());
        }
        let of = |id: &'static str| {
            let own: Vec<&Track> = tracks.iter().filter(|track| track.effect == Some(id)).collect();
            let shows = |flight: &usize| own.iter().any(|track| track.is_shown_by(*flight));
            (id, (!own.is_empty()).then(|| (0..flights.len()).filter(shows).collect()))
        };
        let carried_by = self.explanation.named.iter().map(|named| of(named.id)).collect();
        self.along = Some(AlongFlights { tracks, winds_m_s, carried_by });
    }
}
