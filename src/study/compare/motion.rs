//! What the motion of each flight says of the vehicle's parameters.

use crate::diagnose::{ExplainSettings, Explanation, FlightParameter, by_flight, explain};
use crate::signals::Signals;
use crate::study::{Progress, Track};
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// Each parameter along all flights, and why a flight is not among them. A flight whose commands come too seldom to compare torques
/// with the motion shows its balance only.
pub(super) fn tracks(
    signals: &[Signals],
    vehicle: &Vehicle,
    progress: &dyn Progress,
) -> (Vec<Track>, Vec<Option<String>>) {
    progress.steps(signals.len() as u64);
    let settings = ExplainSettings::default();
    let explained: Vec<Result<Explanation, String>> = signals
        .par_iter()
        .map(|one| {
            if !one.quality.torques {
                return Err("commands or body rates are logged too seldom to compare torques".to_owned());
            }
            let explained = explain(std::slice::from_ref(one), vehicle, &settings);
            progress.step();
            explained.map_err(|error| error.to_string())
        })
        .collect();
    let places: Vec<usize> = (0..signals.len()).filter(|place| explained[*place].is_ok()).collect();
    let used: Vec<Signals> = places.iter().map(|place| signals[*place].clone()).collect();
    let explanations: Vec<&Explanation> = explained.iter().filter_map(|one| one.as_ref().ok()).collect();
    let each = by_flight(&used, &explanations, vehicle, &settings);
    let compared = |parameters: Vec<FlightParameter>| parameters.into_iter().filter(is_compared).collect();
    let each = places.into_iter().zip(each.into_iter().map(compared)).collect();
    let reasons = explained.into_iter().map(Result::err).collect();
    (Track::all(each, signals.len(), vehicle), reasons)
}

/// Where the thrust acts, the balance tells better: offsets, and what one rotor gives.
pub(in crate::study) fn is_compared(parameter: &FlightParameter) -> bool {
    parameter.unit != "m" && !parameter.name.contains('[')
}
