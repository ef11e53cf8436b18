//! The blocks of `figures-fleet.md`.

use super::blocks::{command, paragraph, table};
use super::fleet_figures::{Alarms, CutHistory, Fleet, FoundStep, Histories};
use mavid::text::{significant, with_error};

/// Name and text of each block.
pub fn blocks(measured: &Fleet) -> Vec<(&'static str, String)> {
    vec![
        ("histories", histories(&measured.histories)),
        ("cut propellers", cut_history(&measured.cut_propellers)),
    ]
}

fn bound(alarms: &Alarms) -> String {
    let rate = 100.0 * alarms.called as f64 / (alarms.shuffled.max(1)) as f64;
    format!(
        "{} standard deviations; {} of {} shuffled histories reach it ({} %, at most {} % with 95 % confidence)",
        significant(alarms.least_sigmas, 3),
        alarms.called,
        alarms.shuffled,
        significant(rate, 2),
        significant(alarms.greatest_rate_percent, 2)
    )
}

fn histories(of: &Histories) -> String {
    let from = of.flights / 2 + 1;
    let text = format!(
        "Each of {} vehicles flew {} flights as it is, and {} flights in which one rotor gives {} of its thrust and torque.",
        of.vehicles, of.flights, of.weak_flights, of.factor
    );
    let row = |what: String, result: String| vec![what, result];
    let rows = [
        row(
            format!("histories with a rotor at {} from flight {from} on", of.factor),
            format!(
                "{} of {} found within {} flights of flight {from}, {} with the rotor",
                of.found, of.weakened, of.near, of.named
            ),
        ),
        row(
            "histories without a change".to_owned(),
            format!("{} of {} called changed", of.called_changed, of.unchanged),
        ),
        row("bound by shuffled histories".to_owned(), bound(&of.alarms)),
    ];
    format!("{}\n\n{}\n\n{}", command(&of.command), paragraph(&text), table(&["", "result"], &rows))
}

fn cut_history(of: &CutHistory) -> String {
    let rows: Vec<Vec<String>> = (1..)
        .zip(&of.cuts_mm)
        .map(|(flight, cut_mm)| {
            let propeller = if *cut_mm == 0 { "whole".to_owned() } else { format!("cut by {cut_mm} mm") };
            let step = of.steps.iter().find(|step| step.flight == flight);
            vec![flight.to_string(), propeller, step.map_or_else(String::new, change)]
        })
        .collect();
    let text = if of.alarms.shuffled == 0 {
        let least = significant(of.alarms.least_sigmas, 3);
        format!(
            "The flights have too few orders to shuffle them, so the bound is the least that is ever used: {least} standard deviations."
        )
    } else {
        format!("The bound by shuffled histories: {}.", bound(&of.alarms))
    };
    let head = ["flight", "propeller of motor 1", "changed from this flight on"];
    format!("{}\n\n{}\n\n{}", command(&of.command), table(&head, &rows), paragraph(&text))
}

fn change(step: &FoundStep) -> String {
    match (step.motor, step.after, step.std) {
        (Some(motor), Some(after), Some(std)) => {
            format!("motor {motor} at {} of its thrust for the same command", with_error(after, std))
        }
        _ => "without a name".to_owned(),
    }
}
