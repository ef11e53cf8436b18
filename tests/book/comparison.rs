//! The blocks of `figures-comparison.md`.

use super::blocks::{command, paragraph, table};
use super::comparison_figures::{
    Answer, Comparison, Cut, CutPropellers, FoundChange, Pairs, Pooled, PooledParameter, Sessions, Simulators,
};
use mavid::text::{significant, with_error};

/// Name and text of each block.
pub fn blocks(measured: &Comparison) -> Vec<(&'static str, String)> {
    vec![
        ("pairs", pairs(&measured.pairs)),
        ("pooled", pooled(&measured.pooled)),
        ("cut propellers", cut_propellers(&measured.cut_propellers)),
        ("simulators", simulators(&measured.simulators)),
        ("sessions", sessions(&measured.sessions)),
    ]
}

fn pairs(of: &Pairs) -> String {
    let row = |what: &str, result: String| vec![what.to_owned(), result];
    let rows = [
        row("pairs without a change", format!("{} of {} called changed", of.called_changed, of.unchanged)),
        row(
            &format!("pairs with one rotor at {}", of.factor),
            format!("{} of {} found with the rotor", of.found, of.weakened),
        ),
        row("of these without another explanation that fits nearly as well", of.alone.to_string()),
        row("of these with the factor within 1.96 standard errors", of.covered.to_string()),
        row(
            "smallest change of a rotor that would have been named",
            format!(
                "median {} %, at most {} %",
                significant(of.least_median_percent, 2),
                significant(of.least_greatest_percent, 2)
            ),
        ),
    ];
    format!("{}\n\n{}", command(&of.command), table(&["", "result"], &rows))
}

/// `ixx` as `Ixx`; the others as they are called in the outputs.
fn symbol(name: &str) -> String {
    match name {
        "ixx" | "iyy" | "izz" => format!("I{}", &name[1..]),
        name => format!("`{name}`"),
    }
}

fn pooled(of: &Pooled) -> String {
    let row = |name: String, one: &PooledParameter| {
        vec![
            name,
            one.vehicles.to_string(),
            one.smaller.to_string(),
            format!("{} of {}", one.covered, one.known),
            significant(one.error_ratio, 2),
        ]
    };
    let mut rows: Vec<Vec<String>> = of.parameters.iter().map(|one| row(symbol(&one.name), one)).collect();
    rows.push(row("all, those of unknown truth as well".to_owned(), &of.all));
    let text =
        format!("{} flights of one vehicle, explained together, for {} vehicles:", of.flights, of.vehicles);
    let head = [
        "parameter",
        "vehicles",
        "smaller error than the best single flight",
        "truth within 1.96 standard errors",
        "median error over that of the best single flight",
    ];
    format!("{}\n\n{}\n\n{}", command(&of.command), paragraph(&text), table(&head, &rows))
}

/// Motor of the cut propellers.
const CUT_MOTOR: usize = 1;

fn is_cut_motor(answer: &Answer) -> bool {
    answer.changes.first().is_some_and(|change| change.motor == Some(CUT_MOTOR))
}

fn cut_propellers(of: &CutPropellers) -> String {
    let rows: Vec<Vec<String>> = of.cuts.iter().rev().flat_map(cut_rows).collect();
    let head = [
        "cut",
        "compared",
        "changed",
        "with motor 1",
        "thrust for the same command",
        "standard deviations",
        "smallest change of a rotor that would have been named",
    ];
    format!("{}\n\n{}", command(&of.command), table(&head, &rows))
}

fn cut_rows(cut: &Cut) -> Vec<Vec<String>> {
    let name = if cut.cut_mm == 0 { "whole".to_owned() } else { format!("{} mm", cut.cut_mm) };
    let row = |what: &str, answers: &[&Answer]| {
        let count = |of: fn(&Answer) -> bool| answers.iter().filter(|answer| of(answer)).count();
        let named: Vec<&FoundChange> = answers
            .iter()
            .filter(|answer| is_cut_motor(answer))
            .filter_map(|answer| answer.changes.first())
            .collect();
        let joined = |of: &dyn Fn(&FoundChange) -> String| {
            named.iter().map(|change| of(change)).collect::<Vec<_>>().join("; ")
        };
        let mut least: Vec<f64> = answers.iter().map(|answer| answer.least_rotor_percent).collect();
        least.sort_by(f64::total_cmp);
        let all = answers.len();
        vec![
            name.clone(),
            what.to_owned(),
            format!("{} of {all}", count(|answer| !answer.changes.is_empty())),
            format!("{} of {all}", count(is_cut_motor)),
            joined(&factor),
            joined(&|change| significant(change.sigmas, 2)),
            match least.as_slice() {
                [one] => format!("{} %", significant(*one, 2)),
                [first, .., last] => format!("{} to {} %", significant(*first, 2), significant(*last, 2)),
                [] => String::new(),
            },
        ]
    };
    let each = row("each flight", &cut.single.iter().collect::<Vec<_>>());
    let together = cut.together.iter().map(|answer| row("all three together", &[answer]));
    [each].into_iter().chain(together).collect()
}

/// `0.929 +- 0.004`
fn factor(change: &FoundChange) -> String {
    match (change.after, change.std) {
        (Some(after), Some(std)) => with_error(after, std),
        _ => "-".to_owned(),
    }
}

fn simulators(of: &Simulators) -> String {
    let cell = |answer: &Answer| {
        let change = |change: &FoundChange| match change.motor {
            Some(motor) => format!("rotor {motor} at {}", factor(change)),
            None => format!("{} {}", change.what, factor(change)),
        };
        if answer.changes.is_empty() {
            return format!(
                "nothing changed; {} % would have been named",
                significant(answer.least_rotor_percent, 2)
            );
        }
        answer.changes.iter().map(change).collect::<Vec<_>>().join("; ")
    };
    let rows: Vec<Vec<String>> = of
        .pairs
        .iter()
        .map(|pair| vec![pair.name.clone(), cell(&pair.by_telemetry), cell(&pair.on_board)])
        .collect();
    table(&["pair", "by telemetry", "by on-board log"], &rows)
}

fn sessions(of: &Sessions) -> String {
    let rows: Vec<Vec<String>> = of
        .sessions
        .iter()
        .map(|session| {
            let each = |values: &[f64], digits: i32| {
                values.iter().map(|value| significant(*value, digits)).collect::<Vec<_>>().join(", ")
            };
            vec![session.flights.join(", "), each(&session.at_rest_m_s2, 2), each(&session.balance, 2)]
        })
        .collect();
    let head =
        ["flights", "accelerometer along x before the motors turn, m/s^2", "balance: x, y (arms), about z"];
    let text = format!(
        "Pairs of one group: {} of {} called changed. Pairs of two groups: {} of {}.",
        of.within.1, of.within.0, of.between.1, of.between.0
    );
    format!("{}\n\n{}\n\n{}", command(&of.command), table(&head, &rows), paragraph(&text))
}
