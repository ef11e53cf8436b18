//! The model file, and the parameters along time.

use crate::estimate::{
    Finding, Identification, MethodResult, NAMES, THETA, ThrustScale, UNITS, identified_vehicle,
};
use crate::report::chart::{Line, Panel};
use crate::text::toml_string;
use crate::vehicle::Vehicle;
use std::fmt::Write;

use super::correlation::correlation;
use super::input::InputFile;

/// The model file: the vehicle with its identified values, and where they came from.
///
/// # Errors
/// [`crate::config::ConfigError`] where a value has no form in TOML.
pub fn model_toml(
    identification: &Identification,
    vehicle: &Vehicle,
    inputs: &[InputFile],
    scale: Option<&ThrustScale>,
) -> Result<String, crate::config::ConfigError> {
    let best = &identification.best.result;
    let mut text = crate::config::vehicle_to_toml(&identified_vehicle(vehicle, best, scale))?;
    let _ = writeln!(text, "\n[identified]\nmethod = \"{}\"", best.method.name());
    let _ = writeln!(text, "# what the flight did not determine keeps its nominal value in [body]");
    text.push_str(&identified_entries(best, scale));
    let _ = writeln!(text, "correlation_of = {NAMES:?}");
    let rows: Vec<String> = correlation(best)
        .iter()
        .map(|row| {
            let cells: Vec<String> =
                row.iter().map(|r| r.map_or_else(|| "nan".into(), |r| format!("{r:.4}"))).collect();
            format!("  [{}]", cells.join(", "))
        })
        .collect();
    let _ = writeln!(text, "correlation = [\n{}\n]", rows.join(",\n"));
    text.push_str(&provenance(inputs));
    let _ = writeln!(text, "cutoff_hz = {:.4}", identification.cutoff_hz);
    Ok(text)
}

/// The rigid body's lines of `[identified]`.
pub(super) fn identified_entries(body: &MethodResult, scale: Option<&ThrustScale>) -> String {
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
            Finding::NotDetermined { reason } => writeln!(
                text,
                "{} = {{ status = \"not_determined\", reason = {} }}",
                parameter.name,
                toml_string(reason)
            ),
        };
    }
    if let Some(Finding::Determined { value, std }) = scale.map(|scale| &scale.value) {
        let (name, unit) = scale.map_or(("", ""), |scale| (scale.name, scale.unit));
        let _ = writeln!(text, "{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}");
    }
    text
}

/// Program and inputs.
pub(super) fn provenance(inputs: &[InputFile]) -> String {
    let files: Vec<String> = inputs
        .iter()
        .map(|input| format!("  {{ path = {}, sha256 = \"{}\" }}", toml_string(&input.path), input.sha256))
        .collect();
    let version = env!("CARGO_PKG_VERSION");
    format!("\n[provenance]\nprogram = \"mavid {version}\"\ninputs = [\n{}\n]\n", files.join(",\n"))
}

/// The paper's figures 4 and 5: mass and inertia along time, by method.
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
