//! What the motion of each flight says of the vehicle's parameters.

use super::by_motion::WeakAlone;
use crate::diagnose::signatures::signature_of;
use crate::diagnose::{
    ExplainSettings, Explanation, FlightParameter, LATENCY, Named, Owner, brief, by_flight, explain,
};
use crate::note::{About, Note};
use crate::signals::Signals;
use crate::study::{InputFile, Progress, Track};
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// What the motion of all flights says.
pub(super) struct Motion {
    /// each parameter along all flights
    pub(super) tracks: Vec<Track>,
    /// what each flight names alone of its rotors
    pub(super) alone: Vec<Option<WeakAlone>>,
    /// why a flight is not among them
    pub(super) reasons: Vec<Option<String>>,
    /// what is not compared, and what single flights show of it
    pub(super) notes: Vec<Note>,
}

/// Each parameter along all flights. A flight whose commands come too seldom to compare torques with the motion shows its balance only.
pub(super) fn motion(
    (inputs, signals): (&[InputFile], &[Signals]),
    vehicle: &Vehicle,
    progress: &dyn Progress,
) -> Motion {
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
    let mut tracks: Vec<Track> = Track::all(each, signals.len(), vehicle);
    tracks.iter_mut().for_each(by_what_is_determined);
    let paths = inputs.iter().zip(&explained).filter(|(_, of)| of.is_ok()).map(|(input, _)| &*input.path);
    let of_each: Vec<(&str, &Explanation)> = paths.zip(explanations).collect();
    let weak = |of: &Result<Explanation, String>| WeakAlone::of(of.as_ref().ok()?, vehicle);
    let alone = explained.iter().map(weak).collect();
    let notes = curve(&tracks).into_iter().chain(of_some_flights(&of_each, vehicle)).collect();
    let reasons = explained.iter().map(|of| of.as_ref().err().cloned()).collect();
    Motion { tracks, alone, reasons, notes }
}

/// What a flight does not determine takes no part in a change. The error of an effect holds the spread then, as it is told; a latency is
/// determined by the flight's own.
fn by_what_is_determined(track: &mut Track) {
    if track.name == LATENCY {
        track.keep_determined();
        track.move_spread_into_errors(1.0);
        return;
    }
    track.move_spread_into_errors(1.0);
    if track.owner == Owner::Vehicle {
        track.keep_determined();
    }
}

/// The curve of the thrust is compared where a flight's explanation has it only.
fn curve(tracks: &[Track]) -> Option<Note> {
    let bends = |track: &Track| {
        track.effect.and_then(signature_of).is_some_and(|signature| signature.role.bends_thrust.is_some())
    };
    let text =
        "the thrust curve (thrust against command) is not compared: it is the vehicle file's in all flights";
    (!tracks.is_empty() && !tracks.iter().any(bends)).then(|| Note::remark(About::Vehicle, text))
}

/// Flights that are listed by name; of more their number is told.
const LISTED: usize = 4;

/// What some flights, each explained alone, have by name and others have not: a rotor, where the thrust acts, a latency, a thrust curve.
fn of_some_flights(each: &[(&str, &Explanation)], vehicle: &Vehicle) -> Vec<Note> {
    let is_told = |named: &&Named| {
        let role = signature_of(named.id).map(|signature| &signature.role);
        role.is_some_and(|role| {
            role.which.is_some()
                || role.of_the_loading
                || role.latency.is_some()
                || role.bends_thrust.is_some()
        })
    };
    let names = |explanation: &Explanation| -> Vec<String> {
        explanation.named.iter().filter(is_told).map(|named| brief(named, vehicle, false)).collect()
    };
    let mut told: Vec<String> = Vec::new();
    for name in each.iter().flat_map(|(_, explanation)| names(explanation)) {
        if !told.contains(&name) {
            told.push(name);
        }
    }
    let note = |name: String| {
        let (with, without): (Vec<_>, Vec<_>) =
            each.iter().partition(|(_, explanation)| names(explanation).contains(&name));
        let list = |flights: &[&(&str, &Explanation)]| {
            if flights.len() > LISTED {
                return format!("{} flights", flights.len());
            }
            flights.iter().map(|(path, _)| *path).collect::<Vec<_>>().join(", ")
        };
        let text = || {
            format!(
                "each flight explained alone, against the vehicle file: {name} is named in {} and not in {}",
                list(&with),
                list(&without)
            )
        };
        (!without.is_empty()).then(|| Note::remark(About::Vehicle, text()))
    };
    told.into_iter().filter_map(note).collect()
}

/// Where the thrust acts, the balance tells better: offsets, and what one rotor gives.
pub(in crate::study) fn is_compared(parameter: &FlightParameter) -> bool {
    parameter.unit != "m" && !parameter.name.contains('[')
}
