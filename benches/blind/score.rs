//! Explains the flights and counts.

use std::collections::BTreeMap;

use mavid::config::parse_vehicle;
use mavid::diagnose::{ExplainSettings, Explanation, Named, Verdict, explain};
use mavid::log::{self, OpenOptions};
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use rayon::prelude::*;
use statrs::distribution::{Beta, ContinuousCDF};

use crate::maker::catalogue::{Case, OUTSIDE, PAIRS, identifier};
use crate::maker::flight::Instant;
use crate::maker::hidden::{Ceiling, Ground, Inflow};
use crate::maker::rotors::{below_ceiling, hover_flow, induced, near_ground, ring_excess};

/// What became of a case.
pub struct Answer {
    pub case: Case,
    pub flown: Vec<Instant>,
    pub explanation: Explanation,
}

/// Flies and explains as `mavid prove` does; the reason where it cannot.
pub fn answer(case: Case) -> Result<Answer, String> {
    let flown = case.fly(0).map_err(|lost| format!("{lost:?}"))?;
    let file = std::env::temp_dir().join(format!(
        "mavid_blind_{}_{}_{}.tlog",
        std::process::id(),
        case.seed,
        case.truth.iter().map(|(id, ..)| *id).collect::<String>()
    ));
    std::fs::write(&file, case.log(&flown, 0)).map_err(|error| error.to_string())?;
    let loaded = log::open(&file, &OpenOptions::default()).map_err(|error| error.to_string());
    let _ = std::fs::remove_file(&file);
    let vehicle =
        parse_vehicle(&case.craft.file("blind"), "blind").map_err(|error| error.to_string())?.vehicle;
    let how = ConditionSettings {
        transient_s: Some(1.0),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&loaded?.recording, &vehicle, &how).map_err(|error| error.to_string())?;
    let explanation =
        explain(&[signals], &vehicle, &ExplainSettings::default()).map_err(|error| error.to_string())?;
    Ok(Answer { case, flown, explanation })
}

/// Answers of cases that could be flown, side by side; the others are told.
fn answers(cases: Vec<Case>) -> Vec<Answer> {
    let done: Vec<_> =
        cases.into_par_iter().map(|case| (case.seed, case.expect.clone(), answer(case))).collect();
    done.into_iter()
        .filter_map(|(seed, expect, answer)| {
            answer.map_err(|error| println!("  seed {seed} {expect:?}: not flown or read: {error}")).ok()
        })
        .collect()
}

fn within(name: &Named, id: &str) -> bool {
    name.confusable_with.iter().any(|other| other.id == id)
}

/// One line a wrong answer, with what is needed to repeat it.
fn tell(answer: &Answer) {
    let Answer { case, explanation, .. } = answer;
    let names: Vec<String> = explanation.named.iter().map(told).collect();
    let closest: Vec<&str> = explanation.closest.iter().map(|name| name.id).collect();
    println!(
        "  seed {} {:?}: {} {names:?} closest {closest:?}; {:.2} kg, {:.1} m/s, {:?}",
        case.seed,
        case.truth,
        explanation.verdict.name(),
        case.craft.mass,
        case.room.speed,
        case.conditions,
    );
    // whether the flight showed it at all
    let lowest = answer.flown.iter().map(|now| now.velocity.z).fold(0.0, f64::min);
    let hover = case.craft.hover_speed();
    if let Some(Inflow::VortexRing(share)) = case.hidden.inflow {
        let flow = hover_flow(&case.craft, hover);
        println!(
            "    down at {:.2} of hover's flow {flow:.1} m/s; {:.1} % of thrust lost there",
            lowest / flow,
            100.0 * share * ring_excess(lowest / flow)
        );
    }
    if let Some(load) = case.hidden.load {
        let widest = answer.flown.iter().map(|now| now.swing).fold(0.0, f64::max).to_degrees();
        println!(
            "    load {:.3} of the vehicle's mass, swings up to {widest:.0} degrees",
            load.mass / case.craft.mass
        );
    }
    let limits: Vec<String> = explanation
        .limits
        .iter()
        .filter(|limit| case.expect.contains(&limit.id))
        .map(|limit| format!("{} {} {:.2e}", limit.id, limit.parameter, limit.limit))
        .collect();
    println!("    would have been named from {limits:?}; latency {:?}", explanation.search.latency);
}

/// A name with its values and its confusable effects.
fn told(name: &Named) -> String {
    let values: Vec<String> = name
        .parameters
        .iter()
        .map(|parameter| format!("{} {:.3e}+-{:.1e}", parameter.name, parameter.value, parameter.std))
        .collect();
    let others: Vec<&str> = name.confusable_with.iter().map(|other| other.id).collect();
    format!("{} ({}) {others:?}", name.id, values.join(", "))
}

/// The table of effects.
pub fn effects(entries: &[&'static str], seeds: &[u64]) {
    println!(
        "{:28} {:>7} {:>5} {:>6} {:>6}  verdicts, median error of size, others named",
        "effect", "flights", "named", "in set", "others"
    );
    for &entry in entries {
        let cases = seeds.iter().map(|&seed| Case::new(seed, &[entry])).collect();
        effect(entry, &answers(cases));
    }
}

fn effect(entry: &str, found: &[Answer]) {
    let (mut named, mut in_set, mut others) = (0, 0, 0);
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut strangers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut errors: Vec<f64> = Vec::new();
    for answer in found {
        let Answer { case, explanation, .. } = answer;
        *verdicts.entry(explanation.verdict.name()).or_default() += 1;
        let id = case.expect.last().copied().unwrap_or_default();
        let exact = explanation.named.iter().find(|name| name.id == id);
        if let Some(name) = exact {
            named += 1;
            errors.extend(size_errors(answer, name));
        } else if explanation.named.iter().any(|name| within(name, id)) {
            in_set += 1;
        }
        let mut wrong = exact.is_none() || explanation.verdict != Verdict::Explained;
        for name in &explanation.named {
            let known = case.expect.iter().any(|expect| name.id == *expect || within(name, expect));
            if !known {
                wrong = true;
                others += 1;
                *strangers.entry(name.id).or_default() += 1;
            }
        }
        if wrong || std::env::var_os("BLIND_TELL").is_some() {
            tell(answer);
        }
    }
    errors.sort_by(f64::total_cmp);
    let median = errors.get(errors.len() / 2).map_or_else(|| "-".to_owned(), |error| format!("{error:.1} %"));
    println!(
        "{entry:28} {:7} {named:5} {in_set:6} {others:6}  {verdicts:?} {median} {strangers:?}",
        found.len()
    );
}

/// Percent by which the values are off, where they can be compared.
fn size_errors(answer: &Answer, name: &Named) -> Vec<f64> {
    let Answer { case, .. } = answer;
    if let Some((truth, value)) = derived(answer, name) {
        return vec![100.0 * (value / truth - 1.0).abs()];
    }
    let truth = |parameter: &str| {
        case.truth
            .iter()
            .find(|(id, other, _)| *id == name.id && *other == parameter)
            .map(|(.., value)| *value)
    };
    // which way round is a convention
    let turned = ["imu_misalignment", "frame_misalignment", "blade_flapping"].contains(&name.id);
    let known: Vec<(f64, f64)> = name
        .parameters
        .iter()
        .filter_map(|parameter| {
            let value = if turned { parameter.value.abs() } else { parameter.value };
            let truth = truth(parameter.name)?;
            Some((if turned { truth.abs() } else { truth }, value))
        })
        .collect();
    // what is left of a rotor: the loss counts
    if name.id == "weak_rotor" {
        let right =
            name.parameters.iter().all(|p| p.name != "rotor" || Some(rotor(case, p.value)) == case.weak);
        return known
            .iter()
            .map(
                |(truth, value)| {
                    if right { 100.0 * ((1.0 - value) / (1.0 - truth) - 1.0).abs() } else { 999.0 }
                },
            )
            .collect();
    }
    // of a vector the largest
    let largest = known.iter().fold(0.0_f64, |most, (truth, _)| most.max(truth.abs()));
    known
        .iter()
        .filter(|(truth, _)| truth.abs() > 0.3 * largest || name.id == "mass_change")
        .map(|(truth, value)| 100.0 * (value / truth - 1.0).abs())
        .collect()
}

/// Which rotor a parameter's value means.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small whole number")]
fn rotor(case: &Case, value: f64) -> &'static str {
    case.craft.names[(value.round().max(0.0) as usize).min(3)]
}

/// Truth and found of what both formulae say of the flight: the gain of thrust where it was greatest, and so on.
fn derived(answer: &Answer, name: &Named) -> Option<(f64, f64)> {
    let Answer { case, flown, .. } = answer;
    let value = |wanted: &str| name.parameters.iter().find(|p| p.name == wanted).map(|p| p.value);
    let radius = case.craft.radius;
    match name.id {
        "ground_effect" => {
            let mut heights: Vec<f64> = flown.iter().map(|now| now.position.z).collect();
            heights.sort_by(f64::total_cmp);
            let radii = heights[heights.len() / 20] / radius;
            let image = near_ground(Some(Ground::Image(value("rho")?)), radii);
            let found = match (value("ca"), value("cb")) {
                (Some(a), Some(b)) if a != 0.0 => near_ground(Some(Ground::Exponential(a, b)), radii),
                _ => image,
            };
            Some((near_ground(case.hidden.ground, radii) - 1.0, found - 1.0))
        }
        "ceiling_effect" => {
            let mut heights: Vec<f64> = flown.iter().map(|now| now.position.z).collect();
            heights.sort_by(f64::total_cmp);
            let height = heights[heights.len() * 19 / 20];
            let law = Ceiling::Suction(value("height")?, value("a1")?, value("a2")?);
            let found = below_ceiling(Some(law), height, radius);
            Some((below_ceiling(case.hidden.ceiling, height, radius) - 1.0, found - 1.0))
        }
        "translational_lift" => {
            let Some(Inflow::Edgewise(share)) = case.hidden.inflow else { return None };
            let square = |now: &Instant| now.velocity.xy().norm_squared();
            let mean = flown.iter().map(square).sum::<f64>() / flown.len() as f64;
            let hover = case.craft.hover_speed();
            let thrust = |along: f64| induced(&case.craft, share, hover, (0.0, along));
            Some((4.0 * (thrust(mean.sqrt()) - thrust(0.0)) / mean, value("kh")?))
        }
        _ => None,
    }
}

/// Flights in which nothing is concealed; `entries` may choose the room.
pub fn clean(entries: &[&'static str], seeds: &[u64]) {
    let found = answers(seeds.iter().map(|&seed| Case::new(seed, entries)).collect());
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    let mut false_names = 0_usize;
    for answer in &found {
        *verdicts.entry(answer.explanation.verdict.name()).or_default() += 1;
        false_names += usize::from(!answer.explanation.named.is_empty());
        answer.explanation.named.iter().for_each(|name| *names.entry(name.id).or_default() += 1);
        if answer.explanation.verdict != Verdict::NothingMissing {
            tell(answer);
        }
    }
    println!(
        "nothing concealed {entries:?}: {} flights, {verdicts:?}, {false_names} given a name {names:?}: at most {:.1} % (95 %, Clopper-Pearson)",
        found.len(),
        100.0 * upper(false_names, found.len())
    );
}

/// Upper end of the one-sided 95 % interval of a share.
pub fn upper(count: usize, of: usize) -> f64 {
    if count >= of {
        return 1.0;
    }
    Beta::new(count as f64 + 1.0, (of - count) as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(0.95))
}

/// Two effects at once.
pub fn pairs(first: u64, count: u64) {
    let cases: Vec<Case> =
        (first..first + count).zip(PAIRS.iter().cycle()).map(|(seed, pair)| Case::new(seed, pair)).collect();
    let found = answers(cases);
    let (mut exact, mut set, mut extra) = (0, 0, 0);
    for answer in &found {
        let Answer { case, explanation, .. } = answer;
        let has = |id: &str| explanation.named.iter().any(|name| name.id == id);
        let all = case.expect.iter().all(|id| has(id));
        let near =
            case.expect.iter().all(|id| has(id) || explanation.named.iter().any(|name| within(name, id)));
        let strangers = explanation
            .named
            .iter()
            .filter(|name| !case.expect.iter().any(|id| name.id == *id || within(name, id)))
            .count();
        extra += strangers;
        if all && strangers == 0 {
            exact += 1;
        } else {
            set += usize::from(near && strangers == 0);
            tell(answer);
        }
    }
    println!("pairs: {exact} exact and {set} more by their sets of {}, {extra} others named", found.len());
}

/// What no library has.
pub fn outside(entries: &[&'static str], seeds: &[u64]) {
    debug_assert!(entries.iter().all(|entry| OUTSIDE.contains(entry)));
    for &entry in entries {
        let found = answers(seeds.iter().map(|&seed| Case::new(seed, &[entry])).collect());
        let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        let mut said = 0;
        for Answer { case, explanation, .. } in &found {
            *verdicts.entry(explanation.verdict.name()).or_default() += 1;
            said +=
                usize::from(matches!(explanation.verdict, Verdict::Unexplained | Verdict::PartlyExplained));
            let strange = explanation.named.iter().filter(|name| !case.expect.contains(&name.id));
            strange.for_each(|name| *names.entry(name.id).or_default() += 1);
        }
        found
            .iter()
            .filter(|answer| {
                !matches!(answer.explanation.verdict, Verdict::Unexplained | Verdict::PartlyExplained)
                    || answer.explanation.named.iter().any(|name| !answer.case.expect.contains(&name.id))
            })
            .for_each(tell);
        println!(
            "of no library, {:14} {said} unexplained or partly of {}  {verdicts:?} {names:?}",
            identifier(entry),
            found.len()
        );
    }
}
