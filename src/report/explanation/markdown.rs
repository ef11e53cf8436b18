//! A summary in Markdown, to paste into a forum or an issue: no paths, no positions.

use super::answer::answer;
use super::motor::motor;
use super::no_model::no_model_line;
use super::text::after;
use crate::diagnose::called;
use crate::report::bare::{bare, file_name};
use crate::report::markdown::{escaped, remark, table};
use crate::report::number::{percent, significant, spoken, with_error};
use crate::study::{ExplainStudy, Predicted, QUANTITIES, ValidationData};
use crate::text::capital;
use std::fmt::Write;

/// The summary.
#[must_use]
pub fn explanation_markdown(study: &ExplainStudy) -> String {
    let files = files(study);
    let mut page = format!("**{}**\n", escaped(&bare(&answer(study), &files)));
    named(&mut page, study);
    better(&mut page, study, &files);
    body(&mut page, study);
    let of_holdout = study.shown.iter().flat_map(|shown| &shown.notes).filter(|note| note.is_warning());
    for said in study.notes.iter().chain(of_holdout) {
        remark(&mut page, said, &files);
    }
    let flights: Vec<String> = study
        .given
        .inputs
        .iter()
        .map(|input| {
            let name = file_name(&input.path);
            let hash: String = input.sha256.chars().take(12).collect();
            format!("`{}` (SHA-256 {hash}...)", name.replace('`', "'"))
        })
        .collect();
    let _ = write!(
        page,
        "\nVehicle: {}. Flights: {}. Program: mavid {}, `mavid explain --format md`.\n",
        escaped(&study.given.vehicle.name),
        flights.join(", "),
        env!("CARGO_PKG_VERSION")
    );
    page
}

/// The files of an answer, by their names as given.
fn files(study: &ExplainStudy) -> Vec<&str> {
    let held_out = match &study.shown_on {
        ValidationData::Flights(inputs) => inputs.as_slice(),
        _ => &[],
    };
    let inputs = study.given.inputs.iter().chain(held_out);
    inputs
        .flat_map(|input| {
            std::iter::once(&input.path)
                .chain(input.other_logs.iter().map(|(path, _)| path))
                .map(String::as_str)
        })
        .collect()
}

fn named(page: &mut String, study: &ExplainStudy) {
    let mut rows = Vec::new();
    for effect in &study.effects {
        for p in &effect.parameters {
            let (value, unit) = match motor(study, effect, p.name) {
                Some(motor) => (motor, String::new()),
                None => (with_error(p.value, p.std), spoken(p.unit).to_string()),
            };
            rows.push(vec![called(effect.id).to_owned(), p.name.to_owned(), value, unit]);
        }
    }
    table(page, &["effect", "parameter", "value", "unit"], &rows);
}

fn better(page: &mut String, study: &ExplainStudy, files: &[&str]) {
    let (predicted, on) = match &study.holdout {
        Some(of) => (Some(of), study.shown_on.heading()),
        None => (study.identify.as_ref(), "flights explained".to_owned()),
    };
    let rows = predicted.map_or_else(Vec::new, rows_of);
    if !rows.is_empty() {
        let _ = write!(page, "\nError of a prediction over 0.5 s ({}):\n", escaped(&bare(&on, files)));
    }
    let columns = ["", "unchanged", "rigid body", "model found", "better by", "unit"];
    table(page, &columns, &rows);
    if !rows.is_empty() {
        page.push_str("\nunchanged: a state that does not change; better by: than the better one of it and the rigid body\n");
    }
    if let Some(line) = predicted.and_then(no_model_line) {
        let _ = writeln!(page, "\n{}.", capital(&line));
    }
}

fn rows_of(predicted: &Predicted) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let Some(of) = predicted.at_half_second() else { return rows };
    for (compared, (name, unit)) in of.quantities().iter().zip(QUANTITIES) {
        let Some(compared) = compared else { continue };
        rows.push(vec![
            name.to_owned(),
            compared.unchanged.map_or_else(|| "-".to_owned(), |of| significant(of.value, 3)),
            significant(compared.before.value, 3),
            significant(compared.after.value, 3),
            percent(&compared.improvement_percent),
            unit.to_owned(),
        ]);
    }
    rows
}

fn body(page: &mut String, study: &ExplainStudy) {
    let rows: Vec<Vec<String>> = study
        .body()
        .iter()
        .map(|of| vec![of.name.to_owned(), significant(of.nominal, 4), after(of), of.unit.to_owned()])
        .collect();
    table(page, &["parameter", "vehicle file", "identified", "unit"], &rows);
}
