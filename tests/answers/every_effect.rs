//! Each effect of the library is named where it is concealed in a flight that shows it.

use crate::concealed;
use crate::ordinary;

use std::collections::BTreeSet;

use concealed::Flight;
use mavid::diagnose::Explanation;
use mavid::diagnose::signatures::signature_of;
use mavid::physics::effects::ALL;
use mavid::simulate::random_vehicle;
use ordinary::{ORDINARY, Ordinary, STATED};
use rayon::prelude::*;

/// Hover, and three periods of the trajectory.
const DURATION_S: f64 = 34.0;
/// Of vehicle, trajectory and noise.
const SEED: u64 = 5;

#[test]
fn every_effect_has_a_usual_size_and_every_entry_an_effect() {
    let known: BTreeSet<&str> = ALL.iter().map(|effect| effect.id()).collect();
    let vehicle = random_vehicle(SEED).truth;
    let is_sized = |id: &&&str| signature_of(id).is_some_and(|one| one.usual_values(&vehicle).is_some());
    let missing: Vec<_> = known.iter().filter(|id| !is_sized(id)).collect();
    assert!(missing.is_empty(), "no flight shows {missing:?}: state usual sizes in the signature (`sizes`)");
    let unknown: Vec<_> =
        STATED.iter().filter(|entry| !known.contains(entry.id)).map(|entry| entry.id).collect();
    assert!(
        unknown.is_empty(),
        "{unknown:?}: not in physics::effects::ALL, take the entry out of STATED in tests/support/ordinary.rs"
    );
}

#[test]
fn each_effect_is_named_in_a_flight_that_shows_it() {
    let wrong: Vec<String> = ORDINARY.par_iter().filter_map(failure).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// What is wrong with the answer to an entry's flight.
fn failure(entry: &Ordinary) -> Option<String> {
    let found = fly(entry);
    (!stands_for(&found, entry.id)).then(|| format!("{}: {}", entry.id, answer(&found)))
}

/// Named, or in the confusable set of what is named.
fn stands_for(found: &Explanation, id: &str) -> bool {
    let set = found.named.iter().flat_map(|named| &named.confusable_with);
    found.named.iter().any(|named| named.id == id) || set.into_iter().any(|other| other.id == id)
}

/// Verdict and names, each with its confusable set.
fn answer(found: &Explanation) -> String {
    let names = found.named.iter().map(|named| {
        let set: Vec<_> = named.confusable_with.iter().map(|other| other.id).collect();
        format!("{} (confusable with {set:?})", named.id)
    });
    let closest: Vec<_> = found.closest.iter().map(|named| named.id).collect();
    format!("{}, named {:?}, closest {closest:?}", found.verdict.name(), names.collect::<Vec<_>>())
}

fn fly(entry: &Ordinary) -> Explanation {
    let mut flight = Flight::of_seed(SEED);
    flight.settings.duration_s = DURATION_S;
    let vehicle = flight.vehicle();
    flight.stated_lag_s = entry.shown_by.prepare(&vehicle, &mut flight.trajectory, &mut flight.settings);
    let mut effects = vec![entry.effect(&vehicle)];
    effects.extend(entry.companion(&vehicle));
    flight.explained(effects)
}
