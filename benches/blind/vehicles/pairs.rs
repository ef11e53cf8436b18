//! Pairs of flights: unchanged vehicles, and vehicles one rotor of which became weak.

use mavid::study::{Changed, CompareRequest, CompareStudy, Silent, VehicleGiven, compare};
use rayon::prelude::*;

use super::made::{LEFT, Logs, pair};
use crate::support::comparison::Pairs;
use crate::support::digits::{quantile, short};

/// What was answered of a pair.
struct Answer {
    /// rotor that is weak in the later flight; `None`: unchanged
    weak: Option<usize>,
    changed: bool,
    /// rotor, factor and standard error of the strongest change
    rotor: Option<(usize, f64, f64)>,
    /// others may be it
    rivals: usize,
    least: f64,
    line: String,
}

/// Compares `count` unchanged pairs and as many with a weak rotor.
pub fn run(seed: u64, count: u64) -> Pairs {
    let requests: Vec<(u64, bool)> = [false, true]
        .into_iter()
        .flat_map(|changed| (seed..seed + count).map(move |seed| (seed, changed)))
        .collect();
    let answers: Vec<Answer> =
        requests.par_iter().filter_map(|(seed, changed)| one(*seed, *changed)).collect();
    let (same, weak): (Vec<&Answer>, Vec<&Answer>) = answers.iter().partition(|answer| answer.weak.is_none());
    let called: Vec<&&Answer> = same.iter().filter(|answer| answer.changed).collect();
    called.iter().for_each(|answer| println!("  unchanged, called changed: {}", answer.line));
    let is_right = |answer: &&&Answer| answer.rotor.is_some_and(|(rotor, ..)| Some(rotor) == answer.weak);
    let right: Vec<&&Answer> = weak.iter().filter(is_right).collect();
    let missed = weak.iter().filter(|answer| !is_right(answer));
    missed.for_each(|answer| println!("  weak, not found: {}", answer.line));
    let off = |answer: &&&Answer| answer.rotor.map_or(f64::NAN, |(_, factor, std)| (factor - LEFT) / std);
    let mut least: Vec<f64> = answers.iter().map(|answer| 100.0 * answer.least).collect();
    let figures = Pairs {
        unchanged: same.len(),
        called_changed: called.len(),
        factor: LEFT,
        weakened: weak.len(),
        found: right.len(),
        alone: right.iter().filter(|answer| answer.rivals == 0).count(),
        covered: right.iter().filter(|answer| off(answer).abs() < 1.96).count(),
        least_median_percent: quantile(&mut least, 0.5).map_or(f64::NAN, short),
        least_greatest_percent: quantile(&mut least, 1.0 - f64::EPSILON).map_or(f64::NAN, short),
        ..Pairs::default()
    };
    println!("unchanged pairs: {} of {} called changed", figures.called_changed, figures.unchanged);
    println!(
        "one rotor at {LEFT}: {} of {} found with the rotor, {} of them without another that it may be; \
         the factor lies within 1.96 standard errors in {}",
        figures.found, figures.weakened, figures.alone, figures.covered
    );
    println!(
        "smallest change of a rotor that would have been named: median {:.2} %, most {:.2} %",
        figures.least_median_percent, figures.least_greatest_percent
    );
    figures
}

fn one(seed: u64, changed: bool) -> Option<Answer> {
    let kind = if changed { "weak" } else { "same" };
    let folder = std::env::temp_dir().join(format!("mavid_pair_{}_{kind}_{seed}", std::process::id()));
    let answer = pair(&folder, seed, changed).and_then(|made| {
        let study = compare(&request(&made), &Silent).map_err(|error| error.to_string())?;
        Ok(answer_of(seed, &made, &study))
    });
    let _ = std::fs::remove_dir_all(&folder);
    answer.map_err(|why| println!("  seed {seed}, {kind}: not flown or read: {why}")).ok()
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

fn answer_of(seed: u64, made: &Logs, study: &CompareStudy) -> Answer {
    let compared = study.compared.as_ref().expect("two groups");
    let rotor = compared.changes.iter().find_map(|change| match (change.what, change.moved) {
        (Changed::Rotor(rotor), Some(moved)) => Some((rotor, moved.after.0, moved.by.1)),
        _ => None,
    });
    let lines: Vec<String> = compared
        .changes
        .iter()
        .map(|change| {
            format!("{:?} {:?} may be {:?}", change.what, change.moved.map(|moved| moved.by), change.rivals)
        })
        .collect();
    Answer {
        weak: made.weak,
        changed: !compared.changes.is_empty(),
        rotor,
        rivals: compared.changes.iter().map(|change| change.rivals.len()).sum(),
        least: compared.balance.least.rotors.iter().copied().fold(0.0, f64::max),
        line: format!("seed {seed}, rotor {:?}: {}", made.weak, lines.join("; ")),
    }
}
