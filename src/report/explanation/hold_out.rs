//! The section on the fit before and after, and on the hold-out.

use super::no_model::{by_model_file, no_model_line};
use crate::compare::SIGNALS;
use crate::diagnose::holdout::{AtEnd, Compared, HoldoutFit, OpenLoop};
use crate::diagnose::{AXES, CHANNEL_NAMES};
use crate::report::html::{Cell, note, number, section, table, text, warning};
use crate::report::number::{percent, significant, spoken, with_error};
use crate::study::{ExplainStudy, Predicted, QUANTITIES, ValidationData};
use crate::text::capital;
use maud::{Markup, html};

const COMPARED: [&str; 6] = ["", "before|", "after|", "noise alone|", "better by|", "unit"];
const PREDICTED: [&str; 7] = ["", "unchanged|", "before|", "after|", "noise alone|", "better by|", "unit"];
const AT_END: [&str; 5] = ["", "unchanged|", "before|", "after|", "unit"];

/// Errors of a prediction over half a second, before and after, on the flights that were not used if there are such.
pub(super) fn hold_out(study: &ExplainStudy) -> Markup {
    let content = html! {
        @if let Some(predicted) = &study.holdout {
            (at_horizon(&study.shown_on.heading(), predicted))
        } @else if let Some(predicted) = &study.identify {
            (at_horizon("flights explained", predicted))
        }
        @if let ValidationData::Nothing { reason } = &study.shown_on {
            (warning(&format!("Not shown on unused data: {reason}.")))
        }
        (note("Open-loop prediction from the measured state with the recorded actuators. Before: the rigid body identified on \
               the same flights. Unchanged: a state that does not change. Better by: than the better one of these two, with 95 % \
               intervals of a bootstrap over blocks of the flight. Noise alone: what white noise of the sensors would cause \
               with the right model."))
    };
    section("How much better", &content)
}

fn at_horizon(on: &str, predicted: &Predicted) -> Markup {
    let (rows, _) = rows(predicted.at_half_second());
    html! {
        (table(&format!("Prediction error, rms, {on}{}", mean(predicted)), &PREDICTED, &rows))
        @if let Some(line) = no_model_line(predicted) { (warning(&format!("{}.", capital(&line)))) }
    }
}

/// All errors before and after, on the explained flights and on the hold-out flights.
pub(super) fn hold_out_details(study: &ExplainStudy) -> Markup {
    let content = html! {
        (note("At the horizon: the mean size of the error at the end of the window, one window each 0.17 s."))
        @if let Some(predicted) = &study.identify { (prediction("flights explained", predicted)) }
        @if let Some(predicted) = &study.holdout { (prediction(&study.shown_on.heading(), predicted)) }
        @if let Some(written) = by_model_file(study) {
            (prediction(&format!("{}, with model.toml as it is", study.shown_on.heading()), written))
        }
        @if let Some(shown) = &study.shown {
            @if let Some(why) = &shown.no_open_loop {
                (note(&format!("Nothing could be predicted in open loop: {why}.")))
            }
            (weak_form(shown))
            (closed_loop(shown))
            (agreement(shown))
            @for said in &shown.notes { (note(&said.sentence())) }
        }
    };
    section("Fit before and after", &content)
}

fn compared_row(name: &str, unit: &str, of: &Compared) -> Vec<Cell> {
    vec![
        text(name),
        number(significant(of.before.value, 3)),
        number(significant(of.after.value, 3)),
        number(of.floor.map_or_else(|| "-".to_owned(), |floor| significant(floor, 3))),
        number(percent(&of.improvement_percent)),
        text(unit),
    ]
}

/// Rows of the errors over windows, and of those at their ends.
fn rows<'a>(windows: impl IntoIterator<Item = &'a OpenLoop>) -> (Vec<Vec<Cell>>, Vec<Vec<Cell>>) {
    let (mut rows, mut at_end) = (Vec::new(), Vec::new());
    for of in windows {
        for (compared, (name, unit)) in of.quantities().iter().zip(QUANTITIES) {
            let Some(compared) = compared else { continue };
            let mut row = compared_row(&format!("{name}, {} s", of.window_s), unit, compared);
            row.insert(
                1,
                number(compared.unchanged.map_or_else(|| "-".to_owned(), |of| significant(of.value, 3))),
            );
            rows.push(row);
            if let Some(AtEnd { unchanged, before, after }) = compared.at_end {
                let mut row = vec![text(format!("{name} after {} s", of.window_s))];
                row.extend([unchanged, before, after].map(|error| number(significant(error, 3))));
                row.push(text(unit));
                at_end.push(row);
            }
        }
    }
    (rows, at_end)
}

fn mean(predicted: &Predicted) -> String {
    predicted
        .improvement_percent
        .map_or_else(String::new, |mean| format!("; mean at 0.5 s better by {}", percent(&mean)))
}

fn prediction(on: &str, predicted: &Predicted) -> Markup {
    let (rows, at_end) = rows(&predicted.open_loop);
    html! {
        (table(&format!("Prediction error, rms, {on}{}", mean(predicted)), &PREDICTED, &rows))
        (table(&format!("Error at the horizon, mean, {on}"), &AT_END, &at_end))
        @if let Some(line) = no_model_line(predicted) { (note(&format!("{}.", capital(&line)))) }
    }
}

fn weak_form(shown: &HoldoutFit) -> Markup {
    let rows: Vec<Vec<Cell>> = shown
        .weak
        .iter()
        .zip(CHANNEL_NAMES)
        .take(AXES)
        .filter_map(|(of, name)| {
            let unit = if name.starts_with("force") { "N" } else { "N m" };
            Some(compared_row(&name.replace('_', " "), unit, of.as_ref()?))
        })
        .collect();
    table("Residual of the weak form on the same flights, rms", &COMPARED, &rows)
}

fn closed_loop(shown: &HoldoutFit) -> Markup {
    match &shown.closed_loop {
        Ok(flown) => {
            let rows: Vec<Vec<Cell>> = flown
                .signals
                .iter()
                .zip(SIGNALS)
                .filter_map(|(of, (name, unit))| Some(compared_row(name, unit, of.as_ref()?)))
                .collect();
            table(
                "Simulated in closed loop from the recorded setpoints with the simulator's own controller, rms",
                &COMPARED,
                &rows,
            )
        }
        Err(why) => note(&format!("Not simulated in closed loop: {why}.")),
    }
}

fn agreement(shown: &HoldoutFit) -> Markup {
    let rows: Vec<Vec<Cell>> = shown
        .agreement
        .iter()
        .map(|of| {
            vec![
                text(of.name.as_str()),
                number(with_error(of.identified, of.identified_std)),
                number(with_error(of.held_out, of.held_out_std)),
                number(format!("{:+.1}", of.sigmas())),
                text(spoken(of.unit)),
            ]
        })
        .collect();
    table(
        "The same parameters from these flights alone",
        &["parameter", "identified|", "from these alone|", "apart, sigma|", "unit"],
        &rows,
    )
}
