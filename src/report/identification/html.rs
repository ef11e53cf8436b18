//! `report.html` of `identify`: each section is one function, and one call in [`identification_html`].

use super::model::history_charts;
use super::words::verdict;
use crate::diagnose::called;
use crate::diagnose::joint::{EffectFound, Found, ParameterFound};
use crate::estimate::{Finding, NAMES, theta_of};
use crate::physics::WHICH_ROTOR;
use crate::report::chart::{Line, POINTS, Panel, inline};
use crate::report::html::{self, Cell, figure, note, number, paragraph, section, table, text, warning};
use crate::report::number::{significant, spoken, with_error};
use crate::report::page::page;
use crate::report::quality::data_quality;
use crate::signals::FilterPair;
use crate::study::{COMPONENTS, Correlation, IdentifyStudy, RotorsAndMotion, lost};
use crate::vehicle::Anchor;
use maud::{Markup, html};

/// Parameters whose estimates along the flight are drawn: mass and the moments of inertia.
const DRAWN: [usize; 4] = [0, 1, 4, 6];

/// The answer in one sentence.
fn answer(study: &IdentifyStudy) -> String {
    let parameters = &study.body().parameters;
    let nominal = theta_of(&study.vehicle.body);
    let mut parts = Vec::new();
    if let Finding::Determined { value, std } = parameters[0].finding {
        let percent = 100.0 * (value / nominal[0] - 1.0);
        let than = if percent < 0.0 { "less" } else { "more" };
        let by = significant(percent.abs(), 2);
        parts.push(format!("mass {} kg, {by} % {than} than in the vehicle file", with_error(value, std)));
    }
    let inertia: Vec<String> = [1, 4, 6]
        .into_iter()
        .filter_map(|index| match parameters[index].finding {
            Finding::Determined { value, std } => {
                Some(format!("{} {}", parameters[index].name, with_error(value, std)))
            }
            _ => None,
        })
        .collect();
    if !inertia.is_empty() {
        parts.push(format!("{} kg m^2", inertia.join(", ")));
    }
    if let Some(with) = &study.with {
        let found = with.joint.effects.iter().filter(|effect| effect.is_significant());
        parts.extend(found.map(effect_words));
    }
    let good = verdict(study, study.body());
    let is = if good.starts_with("determines") { "" } else { " is" };
    let parts = if parts.is_empty() { String::new() } else { format!(": {}", parts.join("; ")) };
    format!("The flight{is} {good}{parts}.")
}

/// The report: one file, nothing loaded from anywhere.
#[must_use]
pub fn identification_html(study: &IdentifyStudy) -> String {
    let _stage = tracing::info_span!("report").entered();
    let notes = &study.identification.notes;
    let flights = study.inputs.iter().zip(&study.flights);
    let sections = html! {
        @for said in lost(&study.inputs) { (warning(&said.sentence())) }
        @for said in notes.iter().filter(|note| note.is_warning()) { (warning(&said.to_string())) }
        (against_motion(study))
        (along_the_flight(study))
        (effects(study))
        (rigid_body(study))
        (methods(study))
        (residual(study))
        @for said in notes.iter().filter(|note| !note.is_warning()) { (note(&said.to_string())) }
        (data_quality(flights.map(|(input, flight)| (input.path.as_str(), &flight.quality))))
        (provenance(study))
    };
    page(&format!("mavid identify: {}", study.vehicle.name), &answer(study), &tags(study), &sections)
}

fn tags(study: &IdentifyStudy) -> Vec<String> {
    let flights = study.inputs.len();
    vec![
        format!("method {}", study.identification.best.method.name()),
        format!("{flights} flight{}", if flights == 1 { "" } else { "s" }),
        match study.vehicle.anchor {
            Anchor::Thrust => "thrust as stated".to_owned(),
            Anchor::Mass => "mass as weighed".to_owned(),
        },
    ]
}

fn against_motion(study: &IdentifyStudy) -> Markup {
    let components = study.rotors_and_motion();
    let words = if components.is_empty() {
        "Not drawn: body rates or vertical motion are not recorded."
    } else {
        "Force or torque of the rotors, and the one that the measured motion needs, with mass and inertia of the \
         vehicle file and with those of the rigid body identified without effects; the first flight, low-pass filtered."
    };
    let content = html! {
        (note(words))
        @for of in &components { (figure(&inline(&component(of)), "")) }
    };
    section("Rotors against motion", &content)
}

fn component(of: &RotorsAndMotion) -> Panel {
    let every = of.time_s.len().div_ceil(POINTS).max(1);
    let kept = |values: &[f64]| -> Vec<f64> { values.iter().step_by(every).copied().collect() };
    let line = |label: &str, y: &[f64], colour| Line {
        label: label.to_owned(),
        x: kept(&of.time_s),
        y: kept(y),
        colour: Some(colour),
        ..Line::default()
    };
    let (name, unit) = COMPONENTS[of.component];
    let name = name.split_once(": ").map_or(name, |(_, name)| name);
    Panel {
        title: format!("{name}, by the rotors and by the motion"),
        x_label: "time (s)".to_owned(),
        y_label: unit.to_owned(),
        lines: vec![
            line("vehicle file", &of.nominal, 1),
            line("identified", &of.identified, 2),
            line("rotors", &of.rotors, 0),
        ],
        ..Panel::default()
    }
}

fn along_the_flight(study: &IdentifyStudy) -> Markup {
    let drawn: Vec<Panel> =
        history_charts(&study.identification).into_iter().filter(|panel| !panel.lines.is_empty()).collect();
    let content = html! {
        (note("The paper's four estimators after each instant of the flight (its figures 4 and 5)."))
        @for panel in DRAWN.iter().filter_map(|index| drawn.get(*index)) { (figure(&inline(panel), "")) }
    };
    section("Estimates along the flight", &content)
}

fn effects(study: &IdentifyStudy) -> Markup {
    let Some(with) = &study.with else { return Markup::default() };
    let content = html! { @for of in &with.joint.effects { (effect(of)) } };
    section("Effects", &content)
}

fn effect(of: &EffectFound) -> Markup {
    let there = if of.is_significant() { "" } else { ", not distinguishable from zero" };
    let rows: Vec<Vec<Cell>> = of
        .parameters
        .iter()
        .map(|parameter| {
            let (value, why) = found(parameter);
            vec![text(parameter.name), number(value), text(spoken(parameter.unit)), text(why)]
        })
        .collect();
    let caption = format!("{}: {:.1} standard errors from zero{there}", of.effect.id(), of.z);
    html! {
        (paragraph(of.effect.sentence()))
        (table(&caption, &["parameter", "value|", "unit", ""], &rows))
    }
}

fn rigid_body(study: &IdentifyStudy) -> Markup {
    let best = &study.identification.best;
    let nominal = theta_of(&study.vehicle.body);
    let without = study.with.as_ref().map(|with| &with.joint.body_before.parameters);
    let rows: Vec<Vec<Cell>> = study
        .body()
        .parameters
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            let (value, why) = said(&parameter.finding);
            let mut cells = vec![text(parameter.name), number(value)];
            cells.extend(without.map(|without| number(said(&without[index].finding).0)));
            cells.extend([number(significant(nominal[index], 4)), text(parameter.unit), text(why)]);
            cells
        })
        .collect();
    let mut heads = vec!["parameter", "value|"];
    heads.extend(without.map(|_| "without effects|"));
    heads.extend(["vehicle file|", "unit", ""]);
    let scale = match &study.scale {
        Some(scale) => {
            let (value, why) = said(&scale.value);
            format!("{} {value} {} {why}", scale.name, scale.unit)
        }
        None => "The stated thrust is trusted: mass and inertia rest on it, Izz on the stated torque per thrust as well."
            .to_owned(),
    };
    let content = html! {
        (note(&format!("Method {}: {}.", best.method.name(), best.why)))
        (table("Mass and inertia with standard errors", &heads, &rows))
        (note(&scale))
        (correlation_table(&study.correlation()))
    };
    section("Rigid body", &content)
}

fn methods(study: &IdentifyStudy) -> Markup {
    let rows: Vec<Vec<Cell>> = study
        .identification
        .methods
        .iter()
        .map(|method| {
            let mut cells = vec![text(method.method.name())];
            cells.extend(method.parameters.iter().map(|parameter| {
                number(match parameter.finding {
                    Finding::Determined { value, .. } | Finding::Given { value } => significant(value, 4),
                    Finding::NotDetermined { .. } => "-".to_owned(),
                })
            }));
            cells
        })
        .collect();
    let heads: Vec<String> =
        std::iter::once("method".to_owned()).chain(NAMES.map(|name| format!("{name}|"))).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    section("Methods", &table("The rigid body by each method; -: not determined", &heads, &rows))
}

fn residual(study: &IdentifyStudy) -> Markup {
    let of = &study.identification;
    let rows: Vec<Vec<Cell>> = of
        .residual_channels
        .iter()
        .zip(of.residual.iter().zip(&of.explained))
        .map(|(channel, (residual, explained))| {
            let unit = if channel.starts_with("torque") { "N m" } else { "N" };
            vec![
                text(channel.replace('_', " ")),
                number(significant(*residual, 3)),
                text(unit),
                number(format!("{:.1}", 100.0 * explained)),
            ]
        })
        .collect();
    html! {
        (table(
            "Residual of each equation with the rigid body, rms, and the explained share of the variance",
            &["equation", "residual|", "unit", "explained %|"],
            &rows,
        ))
        @if let Some(latency) = of.latency.filter(|latency| latency.total_s.is_finite()) {
            (note(&format!(
                "From command to rotor, by the rigid body alone, {} ms.",
                with_error(1e3 * latency.total_s, 1e3 * latency.std_s)
            )))
        }
    }
}

fn provenance(study: &IdentifyStudy) -> Markup {
    let of = &study.identification;
    let files: Vec<_> = study.inputs.iter().map(|input| ("identified from", input)).collect();
    let mut settings = vec![
        ("low-pass of LS, GD, FMLS, FMGD, Hz", significant(of.cutoff_hz, 3)),
        ("lambda of the filters (37), rad/s", significant(FilterPair::PAPER_LAMBDA_RAD_S, 3)),
        ("condition number, columns scaled", significant(of.scaled_condition_number, 3)),
    ];
    settings.extend(
        of.condition_number.map(|condition| ("condition number as flown", significant(condition, 3))),
    );
    html::provenance(&files, &settings)
}

/// An effect's name with its values.
fn effect_words(effect: &EffectFound) -> String {
    let values: Vec<String> = effect
        .parameters
        .iter()
        .filter_map(|parameter| match &parameter.found {
            Found::Determined { value, std } => Some(
                format!("{} {} {}", parameter.name, with_error(*value, *std), spoken(parameter.unit))
                    .trim_end()
                    .to_owned(),
            ),
            _ => None,
        })
        .collect();
    format!("{} ({})", called(effect.effect.id()), values.join(", "))
}

fn correlation_table(of: &Correlation) -> Markup {
    let rows: Vec<Vec<Cell>> = of
        .names
        .iter()
        .zip(&of.rows)
        .map(|(name, row)| {
            let mut cells = vec![text(name.as_str())];
            cells.extend(row.iter().map(|r| number(r.map_or_else(|| "-".to_owned(), |r| format!("{r:.2}")))));
            cells
        })
        .collect();
    let heads: Vec<String> =
        std::iter::once(String::new()).chain(of.names.iter().map(|name| format!("{name}|"))).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    table("Correlation of the estimates", &heads, &rows)
}

/// A value with its standard error, and a reason.
fn said(finding: &Finding) -> (String, String) {
    match finding {
        Finding::Determined { value, std } => (with_error(*value, *std), String::new()),
        Finding::Given { value } => (significant(*value, 4), "weighed".to_owned()),
        Finding::NotDetermined { reason } => ("-".to_owned(), format!("not determined: {reason}")),
    }
}

fn found(parameter: &ParameterFound) -> (String, String) {
    match &parameter.found {
        Found::Given { why, .. } if parameter.name == WHICH_ROTOR => (why.clone(), String::new()),
        Found::Determined { value, std } => (with_error(*value, *std), String::new()),
        Found::AtBound { value, unbounded, std } => (
            significant(*value, 4),
            format!(
                "at the bound of what is physically possible; the estimate without the bound is {}",
                with_error(*unbounded, *std)
            ),
        ),
        Found::Given { value, why } => (significant(*value, 4), why.clone()),
        Found::NotDetermined { reason, .. } => ("-".to_owned(), format!("not determined: {reason}")),
    }
}
