//! Right names.

use super::flights::{Conditions, drawn, fly, vehicle};
use super::measured::{Confused, EffectRun};
use super::ordinary::{Ordinary, ShownBy};
use super::search_steps::print_steps;
use super::support::digits::short;
use mavid::diagnose::{Explanation, Named, Verdict};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Flights with one effect concealed.
pub fn run(entry: &'static Ordinary, first: u64, count: u64) -> EffectRun {
    let id = entry.id;
    let found: Vec<(u64, Explanation)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| Some((seed, fly(seed, &[entry], Conditions::default())?)))
        .collect();
    let (mut named, mut in_set, mut traces) = (0, 0, 0);
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut errors = Vec::new();
    let mut others: BTreeMap<&str, usize> = BTreeMap::new();
    let mut confusable: BTreeMap<String, Confused> = BTreeMap::new();
    for (seed, explanation) in &found {
        *verdicts.entry(explanation.verdict.name()).or_default() += 1;
        let has_it_in_its_set = |name: &Named| name.confusable_with.iter().any(|other| other.id == id);
        if let Some(name) = explanation.named.iter().find(|name| name.id == id) {
            named += 1;
            errors.extend(size_errors(name, &entry.values(&vehicle(*seed))));
            confused(name, &mut confusable);
        } else if explanation.named.iter().any(has_it_in_its_set) {
            in_set += 1;
        } else if explanation.slight.iter().any(|trace| trace.effect.id == id) {
            traces += 1;
        }
        let ids: Vec<&str> =
            explanation.named.iter().chain(&explanation.closest).map(|name| name.id).collect();
        if explanation.verdict != Verdict::Explained || ids != [id] {
            println!(
                "  seed {seed}: {} {ids:?} {} {:?}",
                explanation.verdict.name(),
                drawn(*seed),
                explanation.search.latency
            );
        }
        if std::env::var("SHOW").is_ok_and(|want| want == seed.to_string()) {
            print_steps(explanation);
        }
        let companion = |name: &Named| entry.shown_by == ShownBy::Drag && name.id == "linear_drag";
        for name in &explanation.named {
            if name.id != id && !has_it_in_its_set(name) && !companion(name) {
                *others.entry(name.id).or_default() += 1;
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let median = errors.get(errors.len() / 2).copied();
    println!(
        "{id:20} {:7} {named:6} {in_set:4} {traces:6} {:7}  {verdicts:?} {:.1} % {others:?}",
        found.len(),
        others.values().sum::<usize>(),
        median.unwrap_or(f64::NAN)
    );
    let owned = |counts: BTreeMap<&str, usize>| {
        counts.into_iter().map(|(name, count)| (name.to_owned(), count)).collect()
    };
    EffectRun {
        id: id.to_owned(),
        flights: found.len(),
        named,
        in_set,
        traces,
        others: owned(others),
        verdicts: owned(verdicts),
        size_error_percent: median.map(short),
        confusable,
    }
}

/// Error of each parameter that was estimated, % of the truth.
fn size_errors(name: &Named, truth: &[(&str, f64)]) -> Vec<f64> {
    let of = |(parameter, truth): &(&str, f64)| {
        let found = name.get(parameter).filter(|found| *truth != 0.0 && found.std > 0.0)?;
        Some(100.0 * (found.value / truth - 1.0).abs())
    };
    truth.iter().filter_map(of).collect()
}

/// Counts the confusable set of a name.
fn confused(name: &Named, counts: &mut BTreeMap<String, Confused>) {
    for other in &name.confusable_with {
        let count = counts.entry(other.id.to_owned()).or_default();
        count.flights += 1;
        let distance = other.distinguishability.map(short);
        count.least_distance = match (count.least_distance, distance) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (known, new) => known.or(new),
        };
    }
}
