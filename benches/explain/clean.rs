//! False names.

use super::flights::{Conditions, drawn, fly};
use super::measured::Clean;
use mavid::diagnose::Verdict;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Flights where nothing is concealed.
pub fn run(first: u64, count: u64, with: Conditions) -> Clean {
    let found: Vec<(u64, Verdict, Vec<&str>)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| {
            let explanation = fly(seed, &[], with)?;
            let names = explanation.named.iter().chain(&explanation.closest).map(|named| named.id).collect();
            Some((seed, explanation.verdict, names))
        })
        .collect();
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    for (seed, verdict, names) in &found {
        *verdicts.entry(verdict.name()).or_default() += 1;
        if *verdict != Verdict::NothingMissing {
            println!("false: seed {seed} {} {names:?} {}", verdict.name(), drawn(*seed));
        }
    }
    println!("{} clean flights: {verdicts:?}", found.len());
    let wrong = found.len() - verdicts.get(Verdict::NothingMissing.name()).copied().unwrap_or(0);
    let named = found
        .iter()
        .filter(|(_, verdict, names)| *verdict != Verdict::Unexplained && !names.is_empty())
        .count();
    println!("  named {named}, any finding {wrong} of {}", found.len());
    Clean { flights: found.len(), named, found: wrong }
}
