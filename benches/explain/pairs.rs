//! Two effects at once.

use super::flights::{Conditions, drawn, fly};
use super::measured::PairRun;
use super::ordinary::{ShownBy, ordinary};
use rayon::prelude::*;

const PAIRS: [(&str, &str); 10] = [
    ("linear_drag", "ground_effect"),
    ("linear_drag", "weak_rotor"),
    ("linear_drag", "motor_lag"),
    ("linear_drag", "mass_change"),
    ("linear_drag", "thrust_tilt"),
    ("battery_sag", "linear_drag"),
    ("inflow", "motor_lag"),
    ("com_offset", "blade_flapping"),
    ("com_offset", "ground_effect"),
    ("quadratic_drag", "transport_delay"),
];

/// Seed, names, and the confusable set of each.
type Pair = (u64, Vec<&'static str>, Vec<Vec<&'static str>>);

/// Flights with two effects concealed: how often both are named and nothing else.
pub fn run(first: u64, count: u64) -> Vec<PairRun> {
    PAIRS.iter().filter(|_| count > 0).map(|pair| of_pair(*pair, first, count)).collect()
}

fn of_pair((one, other): (&str, &str), first: u64, count: u64) -> PairRun {
    let mut entries = [one, other].map(|id| ordinary(id).expect("an effect of the library"));
    // what is shown by a flight of its own decides how it is flown
    entries.sort_by_key(|entry| entry.shown_by == ShownBy::Motion);
    let found: Vec<Pair> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| {
            let explanation = fly(seed, &entries, Conditions::default())?;
            let names = explanation.named.iter().map(|named| named.id).collect();
            let sets = explanation.named.iter();
            let sets = sets.map(|named| named.confusable_with.iter().map(|other| other.id).collect());
            Some((seed, names, sets.collect()))
        })
        .collect();
    let has = |names: &[&str], sets: &[Vec<&str>], id: &str| {
        names.contains(&id) || sets.iter().any(|set| set.contains(&id))
    };
    let both = |(_, names, sets): &&Pair| has(names, sets, one) && has(names, sets, other);
    let exact = found.iter().filter(both).filter(|(_, names, _)| names.len() == 2).count();
    let both_count = found.iter().filter(both).count();
    println!(
        "{:34} {:3} flights, both {both_count:3}, and nothing else {exact:3}",
        format!("{one} + {other}"),
        found.len(),
    );
    for pair in found.iter().filter(|pair| !(pair.1.len() == 2 && both(pair))) {
        println!("  seed {}: {:?} {}", pair.0, pair.1, drawn(pair.0));
    }
    PairRun { effects: [one.to_owned(), other.to_owned()], flights: found.len(), both: both_count, exact }
}
