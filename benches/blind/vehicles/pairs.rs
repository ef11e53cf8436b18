//! Pairs of flights: unchanged vehicles, and vehicles one rotor of which became weak.

use mavid::study::{Changed, CompareRequest, CompareStudy, Silent, VehicleGiven, compare};
use rayon::prelude::*;

use super::made::{LEFT, Logs, pair};

/// What was said of a pair.
struct Said {
    /// rotor and factor of the pair; none: unchanged
    weak: Option<usize>,
    changed: bool,
    /// of the strongest change
    rotor: Option<(usize, f64, f64)>,
    /// others may be it
    rivals: usize,
    least: f64,
    line: String,
}

/// Compares `count` unchanged pairs and as many with a weak rotor.
pub fn run(seed: u64, count: u64) {
    let wanted: Vec<(u64, bool)> = [false, true]
        .into_iter()
        .flat_map(|changed| (seed..seed + count).map(move |seed| (seed, changed)))
        .collect();
    let said: Vec<Said> = wanted.par_iter().filter_map(|(seed, changed)| one(*seed, *changed)).collect();
    let (same, weak): (Vec<&Said>, Vec<&Said>) = said.iter().partition(|said| said.weak.is_none());
    let called: Vec<&&Said> = same.iter().filter(|said| said.changed).collect();
    called.iter().for_each(|said| println!("  unchanged, called changed: {}", said.line));
    let is_right = |said: &&&Said| said.rotor.is_some_and(|(rotor, ..)| Some(rotor) == said.weak);
    let right: Vec<&&Said> = weak.iter().filter(is_right).collect();
    weak.iter().filter(|said| !is_right(said)).for_each(|said| println!("  weak, not found: {}", said.line));
    let alone = right.iter().filter(|said| said.rivals == 0).count();
    let off = |said: &&&Said| said.rotor.map_or(f64::NAN, |(_, factor, std)| (factor - LEFT) / std);
    let inside = right.iter().filter(|said| off(said).abs() < 1.96).count();
    let mut least: Vec<f64> = said.iter().map(|said| said.least).collect();
    least.sort_by(f64::total_cmp);
    println!("unchanged pairs: {} of {} called changed", called.len(), same.len());
    println!(
        "one rotor at {LEFT}: {} of {} found with the rotor, {alone} of them without another that it may be; \
         the factor lies within 1.96 standard errors in {inside}",
        right.len(),
        weak.len()
    );
    println!(
        "smallest change of a rotor that would have been named: median {:.2} %, most {:.2} %",
        100.0 * least[least.len() / 2],
        100.0 * least[least.len() - 1]
    );
}

fn one(seed: u64, changed: bool) -> Option<Said> {
    let kind = if changed { "weak" } else { "same" };
    let folder = std::env::temp_dir().join(format!("mavid_pair_{}_{kind}_{seed}", std::process::id()));
    let said = pair(&folder, seed, changed).and_then(|made| {
        let study = compare(&request(&made), &Silent).map_err(|error| error.to_string())?;
        Ok(said(seed, &made, &study))
    });
    let _ = std::fs::remove_dir_all(&folder);
    said.map_err(|why| println!("  seed {seed}, {kind}: not flown or read: {why}")).ok()
}

fn request(made: &Logs) -> CompareRequest {
    CompareRequest {
        before: made.flights[..1].to_vec(),
        after: made.flights[1..].to_vec(),
        vehicle: Some(VehicleGiven::File(made.file.clone())),
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    }
}

fn said(seed: u64, made: &Logs, study: &CompareStudy) -> Said {
    let compared = study.compared.as_ref().expect("two groups");
    let rotor = compared.changes.iter().find_map(|change| match (change.what, change.moved) {
        (Changed::Rotor(rotor), Some(moved)) => Some((rotor, moved.after.0, moved.by.1)),
        _ => None,
    });
    let told: Vec<String> = compared
        .changes
        .iter()
        .map(|change| {
            format!("{:?} {:?} may be {:?}", change.what, change.moved.map(|moved| moved.by), change.rivals)
        })
        .collect();
    Said {
        weak: made.weak,
        changed: !compared.changes.is_empty(),
        rotor,
        rivals: compared.changes.iter().map(|change| change.rivals.len()).sum(),
        least: compared.balance.least.rotors.iter().copied().fold(0.0, f64::max),
        line: format!("seed {seed}, rotor {:?}: {}", made.weak, told.join("; ")),
    }
}
