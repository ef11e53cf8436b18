//! What the motion of each flight says of the vehicle's parameters.

use super::result::Track;
use crate::change::Spread;
use crate::diagnose::{ExplainSettings, Explanation, FlightParameter, Owner, by_flight, explain};
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// Standard deviation of a moment of inertia between flights of one vehicle beside its error, share: the phase at which a log samples
/// its commands moves it. Measured on two autopilots in simulation: -12 to 2 % (`ardupilot`), 0 to 3 % (`px4`).
const INERTIA: Spread = Spread { relative: 0.05, absolute: 0.0 };
/// The same of an effect: laws are never quite those of the air, and flights differ in speed. Chosen; not measured.
const EFFECT: Spread = Spread { relative: 0.12, absolute: 0.0 };
/// Load and battery are the flight's own.
const OWN: Spread = Spread { relative: 0.0, absolute: 0.0 };

/// Each parameter along all flights, and why a flight is not among them. A flight whose commands come too seldom to compare torques
/// with the motion shows its balance only.
pub(super) fn tracks(signals: &[Signals], vehicle: &Vehicle) -> (Vec<Track>, Vec<Option<String>>) {
    let settings = ExplainSettings::default();
    let explained: Vec<Result<Explanation, String>> = signals
        .par_iter()
        .map(|one| {
            if !one.quality.torques {
                return Err("commands or body rates are logged too seldom to compare torques".to_owned());
            }
            explain(std::slice::from_ref(one), vehicle, &settings).map_err(|error| error.to_string())
        })
        .collect();
    let places: Vec<usize> = (0..signals.len()).filter(|place| explained[*place].is_ok()).collect();
    let used: Vec<Signals> = places.iter().map(|place| signals[*place].clone()).collect();
    let explanations: Vec<&Explanation> = explained.iter().filter_map(|one| one.as_ref().ok()).collect();
    let each = by_flight(&used, &explanations, vehicle, &settings);
    let mut tracks: Vec<Track> = Vec::new();
    for (place, parameters) in places.iter().zip(each) {
        for parameter in parameters.into_iter().filter(is_compared) {
            let known = tracks.iter().position(|track| track.name == parameter.name);
            let at = known.unwrap_or_else(|| {
                tracks.push(track(&parameter, signals.len()));
                tracks.len() - 1
            });
            tracks[at].values[*place] = Some(parameter.estimate);
        }
    }
    (tracks, explained.into_iter().map(Result::err).collect())
}

/// Where the thrust acts, the balance tells better: offsets, and what one rotor gives.
fn is_compared(parameter: &FlightParameter) -> bool {
    parameter.unit != "m" && !parameter.name.contains('[')
}

fn track(parameter: &FlightParameter, flights: usize) -> Track {
    let spread = match (parameter.owner, parameter.effect) {
        (Owner::Flight, _) => OWN,
        (Owner::Vehicle, None) => INERTIA,
        (Owner::Vehicle, Some(_)) => EFFECT,
    };
    Track {
        name: parameter.name.clone(),
        unit: parameter.unit,
        owner: parameter.owner,
        values: vec![None; flights],
        spread,
    }
}
