//! The model file, and the parameters over time.

use crate::config::{ConfigError, vehicle_to_toml};
use crate::diagnose::NO_LATENCY;
use crate::diagnose::joint::{Found, ParameterFound};
use crate::estimate::{
    Finding, Identification, MethodResult, NAMES, THETA, ThrustScale, UNITS, identified_vehicle,
};
use crate::report::chart::{Line, Panel};
use crate::report::model_parts::{as_flown, correlation_lines, effect_tables, not_determined, provenance};
use crate::signals::{airborne_voltage_v, hover_command};
use crate::study::{IdentifyStudy, WithEffects};
use std::fmt::Write;

/// The model file: the vehicle with its identified values, and their provenance.
///
/// # Errors
/// [`ConfigError`] where a value has no form in TOML.
pub fn identified_model(study: &IdentifyStudy) -> Result<String, ConfigError> {
    if let Some(with) = &study.with {
        return model_with(study, with);
    }
    let best = &study.identification.best.result;
    let scale = study.scale.as_ref();
    let mut identified = identified_vehicle(&study.vehicle, best, scale);
    if let Some(share) = study.gyroscopic {
        identified.body.gyroscopic = share.value;
    }
    if let Some(about_z_kg_m2) = study.about_z_kg_m2 {
        // with the torque per thrust that goes with it, it turns the vehicle as the flight does
        identified.body.inertia_kg_m2[(2, 2)] = about_z_kg_m2;
    }
    let mut text = vehicle_to_toml(&identified)?;
    let _ = writeln!(text, "\n[identified]\nmethod = \"{}\"", best.method.name());
    if !study.beside.is_empty() {
        let _ = writeln!(
            text,
            "# estimated together with these effects, which this file does not hold: `mavid explain` writes them"
        );
        let _ = writeln!(text, "beside = {:?}", study.beside);
    }
    let _ = writeln!(text, "{NOT_DETERMINED}");
    text.push_str(&identified_entries(best, scale));
    text.push_str(&flown(study));
    text.push_str(&correlation_lines(&study.correlation()));
    text.push_str(&provenance(&study.inputs));
    let _ = writeln!(text, "cutoff_hz = {:.4}", study.identification.cutoff_hz);
    Ok(text)
}

/// What stands in `[body]` in place of what is not determined.
const NOT_DETERMINED: &str = "# what the flight did not determine is in [body] as the vehicle file states it, unless its reason tells another value";

/// What the flights were flown with.
fn flown(study: &IdentifyStudy) -> String {
    as_flown(airborne_voltage_v(&study.flights), hover_command(&study.flights, &study.vehicle))
}

/// The vehicle with the effects that were identified together with it.
fn model_with(study: &IdentifyStudy, with: &WithEffects) -> Result<String, ConfigError> {
    let joint = &with.joint;
    let mut text = vehicle_to_toml(&joint.vehicle)?;
    text.push_str(&effect_tables(&joint.acting, &joint.vehicle));
    let ids: Vec<&str> = joint.effects.iter().map(|effect| effect.effect.id()).collect();
    let _ = writeln!(text, "\n[identified]\nmethod = \"WEAK\"\nwith = {ids:?}");
    let _ = writeln!(text, "{NOT_DETERMINED}");
    text.push_str(&identified_entries(&joint.body, joint.scale.as_ref()));
    let latency = &joint.latency;
    let _ = if latency.is_determined() {
        let (total_s, std_s) = (latency.total_s, latency.std_s);
        writeln!(text, "latency = {{ value = {total_s:e}, std = {std_s:e}, unit = \"s\" }}")
    } else {
        writeln!(text, "{}", not_determined("latency", NO_LATENCY))
    };
    text.push_str(&flown(study));
    text.push_str(&correlation_lines(&study.correlation()));
    for effect in &joint.effects {
        let _ = writeln!(text, "\n[identified.effects.{}]\nz = {:e}", effect.effect.id(), effect.z);
        for parameter in &effect.parameters {
            let _ = writeln!(text, "{}", effect_entry(parameter));
        }
    }
    text.push_str(&provenance(&study.inputs));
    Ok(text)
}

/// The rigid body's lines of `[identified]`.
fn identified_entries(body: &MethodResult, scale: Option<&ThrustScale>) -> String {
    let mut text = String::new();
    for parameter in &body.parameters {
        let _ = match &parameter.finding {
            Finding::Determined { value, std } => writeln!(
                text,
                "{} = {{ value = {value:e}, std = {std:e}, unit = \"{}\" }}",
                parameter.name, parameter.unit
            ),
            Finding::Given { value } => writeln!(
                text,
                "{} = {{ value = {value:e}, std = 0.0, unit = \"{}\", status = \"given\" }}",
                parameter.name, parameter.unit
            ),
            Finding::NotDetermined { reason } => {
                writeln!(text, "{}", not_determined(parameter.name, reason))
            }
        };
    }
    if let Some(Finding::Determined { value, std }) = scale.map(|scale| &scale.value) {
        let (name, unit) = scale.map_or(("", ""), |scale| (scale.name, scale.unit));
        let _ = writeln!(text, "{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}");
    }
    text
}

fn effect_entry(parameter: &ParameterFound) -> String {
    let ParameterFound { name, unit, found, .. } = parameter;
    match found {
        Found::Determined { value, std } => {
            format!("{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}")
        }
        Found::AtBound { value, unbounded, std } => format!(
            "{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\", status = \"at_bound\", wanted = {unbounded:e} }}"
        ),
        Found::Given { value, why } => {
            format!(
                "{name} = {{ value = {value:e}, std = 0.0, unit = \"{unit}\", status = \"given\", reason = {why:?} }}"
            )
        }
        Found::NotDetermined { reason, .. } => not_determined(name, reason),
    }
}

/// The paper's figures 4 and 5: mass and inertia over time, by method.
#[must_use]
pub fn history_charts(identification: &Identification) -> Vec<Panel> {
    (0..THETA)
        .map(|index| Panel {
            title: format!("{} along time", NAMES[index]),
            x_label: "time, s".into(),
            y_label: format!("{}, {}", NAMES[index], UNITS[index]),
            lines: identification
                .histories
                .iter()
                .map(|(method, history)| Line {
                    label: method.name().into(),
                    x: history.time_s.clone(),
                    y: history.theta.iter().map(|theta| theta[index]).collect(),
                    ..Line::default()
                })
                .collect(),
            ..Panel::default()
        })
        .collect()
}
