//! The blocks of figures of flights with an estimator in the loop.

use super::blocks::{command, listed, paragraph, table};
use super::realistic_figures::{Bias, EffectFlights, Intervals, Realistic};
use mavid::text::significant;

/// Name and text of each block in `figures-diagnosis.md`.
pub fn blocks(measured: &Realistic) -> Vec<(&'static str, String)> {
    vec![
        ("realistic command", command(&measured.command)),
        ("realistic false names", clean(measured)),
        ("realistic right names", right_names(measured)),
        ("realistic intervals", intervals(measured)),
        ("realistic localisation", localisation(measured)),
    ]
}

fn counts(names: &std::collections::BTreeMap<String, usize>) -> String {
    let all: Vec<String> = names.iter().map(|(id, count)| format!("`{id}` {count}")).collect();
    if all.is_empty() { "none".to_owned() } else { listed(&all) }
}

fn clean(measured: &Realistic) -> String {
    let clean = &measured.clean;
    paragraph(&format!(
        "Of {} flights without a concealed effect, {} got a false name ({}), and {} without a name were `unexplained`. The \
         upper 95 % bound by Clopper and Pearson for the rate of false names is {} %.",
        clean.flights,
        clean.named,
        counts(&clean.names),
        clean.unexplained,
        significant(clean.bound_percent, 2)
    ))
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{} %", significant(value, 2)))
}

fn right_names(measured: &Realistic) -> String {
    let row = |run: &EffectFlights| {
        let (Bias { mass, inertia }, with) = (run.without, run.with);
        vec![
            format!("[`{0}`](effects/{0}.md)", run.id),
            format!("{} of {}", run.right, run.flights),
            run.named.to_string(),
            run.in_set.to_string(),
            if run.others.is_empty() { String::new() } else { counts(&run.others) },
            percent(mass),
            percent(with.mass),
            percent(inertia),
            percent(with.inertia),
        ]
    };
    let rows: Vec<Vec<String>> = measured.effects.iter().map(row).collect();
    let head = [
        "effect",
        "right",
        "named",
        "in the set",
        "false names",
        "mass without",
        "with",
        "inertia without",
        "with",
    ];
    let total = |count: &dyn Fn(&EffectFlights) -> usize| measured.effects.iter().map(count).sum::<usize>();
    let (right, flights) = (total(&|run| run.right), total(&|run| run.flights));
    let several = &measured.several;
    let sum = format!(
        "Together {right} of {flights} flights are right ({} %). In {} flights with two or four effects, {} of {} effects are \
         named or in a set, the other names are {}, and {} flights are right.",
        significant(100.0 * right as f64 / flights.max(1) as f64, 2),
        several.flights,
        several.found,
        several.concealed,
        counts(&several.others),
        several.right
    );
    format!("{}\n\n{}", table(&head, &rows), paragraph(&sum))
}

fn intervals(measured: &Realistic) -> String {
    let row = |name: &str, of: &Intervals| {
        let share = |count: usize| {
            format!("{count} ({} %)", significant(100.0 * count as f64 / of.stated.max(1) as f64, 2))
        };
        vec![name.to_owned(), of.stated.to_string(), share(of.near), share(of.inside), share(of.two)]
    };
    let head = ["", "stated", "near", "inside the 95 % interval", "within two standard errors"];
    let rows =
        [row("sizes of effects", &measured.sizes), row("masses and moments of inertia", &measured.bodies)];
    table(&head, &rows)
}

fn localisation(measured: &Realistic) -> String {
    let of = &measured.localisation;
    paragraph(&format!(
        "Of the axes of force and torque, {} were rightly said to lack something, {} wrongly, and {} were missed: F1 is {}.",
        of.hits,
        of.wrong,
        of.missed,
        significant(of.f1, 2)
    ))
}
