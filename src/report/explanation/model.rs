//! The model file of `explain`: the vehicle with its effects, and their provenance.

use super::answer::answer;
use crate::config::{ConfigError, vehicle_to_toml};
use crate::diagnose::holdout::{RateLaw, WINDOWS_S, Without};
use crate::diagnose::{NO_LATENCY, Named};
use crate::estimate::{Finding, ThrustScale};
use crate::report::model_parts::{self, correlation_lines, effect_tables, files};
use crate::study::{ExplainStudy, ValidationData, Worth};
use crate::text::{significant, toml_string};
use nalgebra::Vector3;
use std::fmt::Write;

/// The model file: every command that takes a vehicle takes it.
///
/// # Errors
/// [`ConfigError`] where a value has no form in TOML.
pub fn explained_model(study: &ExplainStudy) -> Result<String, ConfigError> {
    let mut text = vehicle_to_toml(study.vehicle())?;
    text.push_str(&effect_tables(&study.effects_of_model(), study.vehicle()));
    identified(&mut text, study);
    provenance(&mut text, study);
    Ok(text)
}

fn identified(text: &mut String, study: &ExplainStudy) {
    let _ = writeln!(text, "\n[identified]\nmethod = \"explain\"\nverdict = \"{}\"", study.verdict().name());
    let _ = writeln!(text, "answer = {}", toml_string(&answer(study)));
    let entry = |name: &str, value: f64, std: f64, unit: &str| {
        let std = if std.is_finite() { std } else { 0.0 };
        format!("{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}")
    };
    for p in study.body() {
        let line = match &p.not_determined {
            None if p.weighed => format!(
                "{} = {{ value = {:e}, std = 0.0, unit = \"{}\", status = \"given\" }}",
                p.name, p.after.value, p.unit
            ),
            None => entry(p.name, p.after.value, p.after.std, p.unit),
            Some(reason) => model_parts::not_determined(p.name, reason),
        };
        let _ = writeln!(text, "{line}");
    }
    if let Some(ThrustScale { name, unit, value: Finding::Determined { value, std }, .. }) = study.scale() {
        let _ = writeln!(text, "{}", entry(name, value, std, unit));
    }
    let latency = study.latency();
    let _ = if latency.is_determined() {
        writeln!(text, "{}", entry("latency", latency.total_s, latency.std_s, "s"))
    } else {
        writeln!(text, "{}", model_parts::not_determined("latency", NO_LATENCY))
    };
    text.push_str(&model_parts::as_flown(study.given.battery_voltage_v, study.given.hover_command));
    text.push_str(&correlation_lines(&study.correlation()));
    for (effect, flight) in named(study) {
        let _ = writeln!(text, "\n[identified.effects.{}]", effect.id);
        for p in &effect.parameters {
            let _ = writeln!(text, "{}", entry(p.name, p.value, p.std, p.unit));
        }
        let others: Vec<&str> = effect.confusable_with.iter().map(|other| other.id).collect();
        let _ = writeln!(text, "confusable_with = {others:?}");
        if let Some(flight) = flight {
            let path = toml_string(&study.given.inputs[flight].path);
            let _ = writeln!(text, "flight = {path} # alone has it: the model does not");
        }
    }
    if let Some(law) = &study.rate_law {
        rate_law(text, law);
    }
    if let Some(worth) = &study.worth {
        prediction(text, worth);
    }
}

/// The named effects, with the flight that alone of several has one; also those that a flight has by itself and the flights together have not, of
/// each effect one.
fn named(study: &ExplainStudy) -> Vec<(&Named, Option<usize>)> {
    let of_one = |id: &str| study.along.as_ref().and_then(|along| along.flight_with_alone(id));
    let mut all: Vec<(&Named, Option<usize>)> =
        study.effects.iter().map(|effect| (effect, of_one(effect.id))).collect();
    for (flight, effect) in study.along.iter().flat_map(|along| &along.of_one_flight) {
        if all.iter().all(|(known, _)| known.id != effect.id) {
            all.push((effect, Some(*flight)));
        }
    }
    all
}

/// How the rates move in open-loop predictions: no effect, and nothing that a simulation in closed loop may use.
fn rate_law(text: &mut String, law: &RateLaw) {
    let vector = |of: Vector3<f64>| format!("[{:e}, {:e}, {:e}]", of.x, of.y, of.z);
    let _ = writeln!(
        text,
        "\n# open-loop predictions: of the torques this share acts, and the rates decay. It holds for the vehicle under its controller as \
         it was\n# flown, about body x, y and z; units 1, 1/s and rad/s^2\n[identified.rate_law]\nshare = {}\ndecay_1_s = {}\n\
         offset_rad_s2 = {}",
        vector(law.share),
        vector(law.decay_1_s),
        vector(law.offset_rad_s2)
    );
}

/// Errors of prediction with the whole model, and without each effect: what `mavid export` tells of those that it leaves out.
fn prediction(text: &mut String, worth: &Worth) {
    const KEYS: [&str; 4] = ["position_m", "velocity_m_s", "attitude_rad", "rates_rad_s"];
    let numbers =
        |numbers: &[f64]| numbers.iter().map(|number| significant(*number, 3)).collect::<Vec<_>>().join(", ");
    for Without { id, errors, .. } in &worth.each {
        let _ = match id {
            None => writeln!(
                text,
                "\n[identified.prediction]\non = \"{}\"\nwindow_s = {WINDOWS_S:?}",
                if worth.on_explained { "explained" } else { "not_used" }
            ),
            Some(id) => writeln!(text, "\n[identified.prediction.without.{id}]"),
        };
        for (quantity, key) in KEYS.iter().enumerate() {
            let each: Option<Vec<f64>> = errors.iter().map(|errors| errors[quantity]).collect();
            if let Some(each) = each.filter(|each| each.iter().all(|error| error.is_finite())) {
                let _ = writeln!(text, "{key} = [{}]", numbers(&each));
            }
        }
    }
}

fn provenance(text: &mut String, study: &ExplainStudy) {
    text.push_str(&model_parts::provenance(&study.given.inputs));
    match &study.shown_on {
        ValidationData::Flights(inputs) => {
            let _ = writeln!(text, "holdout = {}", files(inputs));
        }
        ValidationData::HeldBack { from_s, .. } => {
            let _ = writeln!(text, "held_back_from_s = {from_s:?}");
        }
        ValidationData::LeftOut { .. } | ValidationData::Nothing { .. } => {}
    }
    let gates = &study.given.settings.gates;
    let _ = writeln!(
        text,
        "transient_s = {:?}\nhalf_width_s = {:?}\ngate_z = {:?}\ngate_gain = {:?}",
        study.given.transient_s, study.given.settings.half_width_s, gates.z, gates.gain
    );
}
