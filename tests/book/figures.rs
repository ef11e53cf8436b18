//! The blocks of measured figures.

use super::blocks::{command, listed, paragraph, table};
use super::effect_page::usual;
use super::measured::Measured;
use mavid::physics::effects::by_id;
use mavid::text::{significant, spoken};
use statrs::distribution::{Beta, ContinuousCDF};

/// Name and text of each block in `figures-diagnosis.md`.
pub fn blocks(measured: &Measured) -> Vec<(&'static str, String)> {
    vec![
        ("command", command(&measured.command)),
        ("false names", clean(measured)),
        ("right names", right_names(measured)),
        ("pairs", pairs(measured)),
        ("detection limits", limits(measured)),
    ]
}

fn clean(measured: &Measured) -> String {
    let clean = &measured.clean;
    let upper = 100.0 * upper_bound(clean.named, clean.flights);
    paragraph(&format!(
        "Of {} flights without a concealed effect, {} got a name and {} got another verdict than `nothing_missing`. The \
         upper 95 % bound by Clopper and Pearson for the rate of false names is {} %.",
        clean.flights,
        clean.named,
        clean.found,
        significant(upper, 2)
    ))
}

/// Upper end of the two-sided interval of 95 % by Clopper and Pearson for a rate of which `count` of `trials` were seen.
fn upper_bound(count: usize, trials: usize) -> f64 {
    if count >= trials {
        return 1.0;
    }
    Beta::new(count as f64 + 1.0, (trials - count) as f64).map_or(1.0, |beta| beta.inverse_cdf(0.975))
}

fn right_names(measured: &Measured) -> String {
    let rows: Vec<Vec<String>> = measured
        .effects
        .iter()
        .map(|run| {
            let others = run.others.iter().map(|(id, count)| format!("`{id}` {count}"));
            vec![
                format!("[`{0}`](effects/{0}.md)", run.id),
                by_id(&run.id).map_or_else(String::new, usual),
                format!("{} of {}", run.named, run.flights),
                run.in_set.to_string(),
                run.traces.to_string(),
                others.collect::<Vec<_>>().join(", "),
                run.size_error_percent
                    .map_or_else(String::new, |error| format!("{} %", significant(error, 2))),
            ]
        })
        .collect();
    let (flights, found) = measured
        .effects
        .iter()
        .fold((0, 0), |(flights, found), run| (flights + run.flights, found + run.named + run.in_set));
    let traces: usize = measured.effects.iter().map(|run| run.traces).sum();
    let others: usize = measured.effects.iter().flat_map(|run| run.others.values()).sum();
    let sum = format!(
        "In {found} of {flights} flights the concealed effect was named or was in the confusable set of the named effect. \
         In {traces} more it was stated as a trace: significant, but too small to matter in the noise of that flight. \
         Other names: {others}."
    );
    let head =
        ["effect", "concealed", "named", "in the set", "as a trace", "others named", "median error of size"];
    format!("{}\n\n{}", table(&head, &rows), paragraph(&sum))
}

fn pairs(measured: &Measured) -> String {
    let rows: Vec<Vec<String>> = measured
        .pairs
        .iter()
        .map(|run| {
            let ids: Vec<String> = run.effects.iter().map(|id| format!("`{id}`")).collect();
            vec![listed(&ids), run.flights.to_string(), run.both.to_string(), run.exact.to_string()]
        })
        .collect();
    table(&["effects", "flights", "both named", "and nothing else"], &rows)
}

fn limits(measured: &Measured) -> String {
    let rows: Vec<Vec<String>> = measured
        .limits
        .iter()
        .map(|limit| {
            vec![
                format!("`{}`", limit.id),
                format!("`{}`", limit.parameter),
                significant(limit.median, 2),
                significant(limit.most, 2),
                spoken(&limit.unit).to_owned(),
            ]
        })
        .collect();
    table(&["effect", "parameter", "median", "90th percentile", "unit"], &rows)
}

#[test]
fn the_bound_is_that_of_clopper_and_pearson() {
    // without a success 1 - 0.025^(1 / n)
    assert!((upper_bound(0, 300) - (1.0 - 0.025_f64.powf(1.0 / 300.0))).abs() < 1e-9);
    assert!(upper_bound(1, 300) > upper_bound(0, 300));
}
