//! The blocks of `figures-identification.md`.

use super::blocks::{command, listed, paragraph, table};
use super::identification_figures::{
    ConcealedEffect, Coverage, Identification, Joint, JointSet, MethodCoverage,
};
use mavid::text::significant;

/// Name and text of each block.
pub fn blocks(measured: &Identification) -> Vec<(&'static str, String)> {
    vec![
        ("coverage", coverage(&measured.coverage)),
        ("joint", joint(&measured.joint)),
        ("slung load", slung_load(&measured.slung_load)),
    ]
}

/// Shares of flights in which the truth is covered, %.
fn covered(of: &MethodCoverage) -> Vec<f64> {
    of.parameters.iter().map(|one| 100.0 * one.covered as f64 / of.flights as f64).collect()
}

/// `93 to 98 %`
fn range(values: &[f64], digits: i32) -> String {
    let [least, greatest] = [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    format!("{} to {} %", significant(least, digits), significant(greatest, digits))
}

fn coverage(measured: &Coverage) -> String {
    let weak = measured.methods.iter().find(|of| of.method == "WEAK").unwrap();
    let others = measured.methods.iter().filter(|of| of.method != "WEAK" && of.method != "best");
    let others: Vec<String> =
        others.map(|of| format!("{} by `{}`", range(&covered(of), 2), of.method)).collect();
    let first = format!(
        "Of {} flights of random vehicles, the 95 % intervals of the weak form cover the truth in {} for each parameter. The \
         intervals of the paper's methods cover it in {}.",
        measured.flights,
        range(&covered(weak), 2),
        listed(&others)
    );
    let row = |(one, share): (&super::identification_figures::ParameterCoverage, f64)| {
        vec![
            one.name.clone(),
            format!("{} %", significant(share, 3)),
            significant(one.error_over_std, 2),
            format!("{} %", significant(one.median_error_percent, 2)),
            format!("{} %", significant(one.high_error_percent, 2)),
            format!("{} %", significant(one.mean_error_percent, 2)),
        ]
    };
    let rows: Vec<Vec<String>> = weak.parameters.iter().zip(covered(weak)).map(row).collect();
    let head = [
        "weak form",
        "covered",
        "error over standard error, rms",
        "error, median",
        "90th percentile",
        "mean of signed errors",
    ];
    format!("{}\n\n{}\n\n{}", command(&measured.command), paragraph(&first), table(&head, &rows))
}

fn sum(sets: &[JointSet], of: impl Fn(&JointSet) -> usize) -> usize {
    sets.iter().map(of).sum()
}

fn joint(measured: &Joint) -> String {
    let sets = &measured.sets;
    let determined = sum(sets, |set| set.determined);
    let worst = sets.iter().map(|set| set.worst_error_percent).fold(0.0, f64::max);
    let text = format!(
        "{} sets of one or two effects were concealed in {} flights of random vehicles and estimated by `--with`. Of the {} \
         parameters that were determined, {} lie within three standard errors and {} within 20 % of the truth; the largest error \
         is {} %. {} were not determined and {} ended at a bound, and the output says so.",
        sets.len(),
        sum(sets, |set| set.flights + set.failed),
        determined,
        sum(sets, |set| set.covered),
        sum(sets, |set| set.near),
        significant(worst, 2),
        sum(sets, |set| set.not_determined),
        sum(sets, |set| set.at_bound),
    );
    format!("{}\n\n{}\n\n{}", command(&measured.command), paragraph(&text), sets_table(sets))
}

fn slung_load(measured: &Joint) -> String {
    format!("{}\n\n{}", command(&measured.command), sets_table(&measured.sets))
}

fn sets_table(sets: &[JointSet]) -> String {
    let concealed = |of: &ConcealedEffect| {
        let names: Vec<String> = of.parameters.iter().map(|name| format!("`{name}`")).collect();
        format!("[`{0}`](effects/{0}.md) ({1})", of.id, names.join(", "))
    };
    let row = |set: &JointSet| {
        let none = set.determined == 0;
        vec![
            set.effects.iter().map(concealed).collect::<Vec<_>>().join(" and "),
            set.flights.to_string(),
            set.determined.to_string(),
            (set.not_determined + set.at_bound).to_string(),
            if none { String::new() } else { format!("{} of {}", set.covered, set.determined) },
            if none { String::new() } else { significant(set.error_over_std, 2) },
            if none { String::new() } else { format!("{} %", significant(set.worst_error_percent, 2)) },
        ]
    };
    let head = [
        "concealed",
        "flights",
        "parameters determined",
        "not determined or at a bound",
        "within three standard errors",
        "error over standard error, rms",
        "largest error",
    ];
    table(&head, &sets.iter().map(row).collect::<Vec<_>>())
}
