//! What `identify --with` says: effects and rigid body, identified together.

use crate::config::{ConfigError, vehicle_to_toml};
use crate::diagnose::CHANNEL_NAMES;
use crate::diagnose::joint::{EffectFound, Found, JointEstimate, ParameterFound, Physical};
use crate::estimate::{Finding, Parameter, theta_of};
use crate::report::model_parts::{correlation, correlations, effect_tables};
use crate::signals::Quality;
use crate::text::compact;
use crate::vehicle::Vehicle;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

use super::input::InputFile;
use super::model::{identified_entries, provenance};
use super::page::{flight_lines, number};
use super::thrust_source::thrust_name;
use super::value::{Thrust, Value, thrust, values};

/// Everything about effects that were identified together with the rigid body.
#[derive(Debug, Clone)]
pub struct WithEffects {
    /// what was found
    pub together: JointEstimate,
    /// nominal
    pub vehicle: Vehicle,
    /// where the signals come from, flight by flight
    pub quality: Vec<Quality>,
}

/// The `with` of the JSON document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct With {
    effects: Vec<EffectValue>,
    parameters: BTreeMap<&'static str, Value>,
    parameters_without: BTreeMap<&'static str, Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    thrust: Option<Thrust>,
    latency: Latency,
    misfit: BTreeMap<&'static str, Misfit>,
    made_physical: bool,
    warnings: Vec<&'static str>,
    correlation_of: Vec<String>,
    correlation: Vec<Vec<Option<f64>>>,
    flights: Vec<Used>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct EffectValue {
    id: &'static str,
    sentence: &'static str,
    /// standard errors from nothing, the forms that were tried allowed for
    z: f64,
    significant: bool,
    tried: usize,
    parameters: Vec<ParameterValue>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct ParameterValue {
    name: &'static str,
    value: Option<f64>,
    std: Option<f64>,
    unit: &'static str,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    wanted: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_at: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Latency {
    value: f64,
    std: f64,
    unit: &'static str,
    delay_s: f64,
    lag_s: f64,
    /// an effect that was asked for, or estimated beside them
    named: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Misfit {
    without: f64,
    with: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Used {
    usable_s: f64,
    total_s: f64,
    excluded: String,
    thrust_from: &'static str,
}

impl WithEffects {
    /// As JSON.
    pub(super) fn document(&self) -> With {
        let together = &self.together;
        let latency = &together.latency;
        let (correlation_of, correlation) = correlation(&together.after);
        With {
            effects: together.effects.iter().map(effect_value).collect(),
            parameters: values(&together.body),
            parameters_without: values(&together.body_before),
            thrust: together.scale.as_ref().map(thrust),
            latency: Latency {
                value: latency.total_s,
                std: latency.std_s,
                unit: "s",
                delay_s: latency.parts.delay_s,
                lag_s: latency.parts.lag_s,
                named: together.latency_named,
            },
            misfit: self
                .misfits()
                .map(|(name, without, with, unit)| (name, Misfit { without, with, unit }))
                .collect(),
            made_physical: together.physical == Physical::Moved,
            warnings: physical(together.physical).into_iter().collect(),
            correlation_of,
            correlation,
            flights: self
                .quality
                .iter()
                .map(|quality| Used {
                    usable_s: quality.usable.usable_s,
                    total_s: quality.usable.total_s,
                    excluded: quality.usable.summary(),
                    thrust_from: thrust_name(quality.thrust_source),
                })
                .collect(),
        }
    }

    /// Channel, without the effects, with them, unit.
    fn misfits(&self) -> impl Iterator<Item = (&'static str, f64, f64, &'static str)> {
        CHANNEL_NAMES.into_iter().zip(self.together.misfit()).filter_map(|(name, misfit)| {
            let (without, with) = misfit?;
            Some((name, without, with, if name.starts_with("torque") { "N m" } else { "N" }))
        })
    }

    /// For people.
    #[must_use]
    pub fn page(&self) -> String {
        let together = &self.together;
        let ids: Vec<&str> = together.effects.iter().map(|effect| effect.effect.id()).collect();
        let mut page =
            format!("{}: {} identified together with the rigid body\n", self.vehicle.name, ids.join(", "));
        for effect in &together.effects {
            let _ = writeln!(page, "  {}: {}", effect.effect.id(), evidence(effect));
        }
        let _ = writeln!(
            page,
            "\n  {:<34}{:>13}{:>13}{:>15}{:>12}  unit",
            "parameter", "value", "std error", "without them", "nominal"
        );
        let nominal = theta_of(&self.vehicle.body);
        let bodies = together.body.parameters.iter().zip(&together.body_before.parameters);
        for (index, (with, without)) in bodies.enumerate() {
            let _ = writeln!(page, "  {}", body_line(with, without, nominal[index]));
        }
        for effect in &together.effects {
            for parameter in &effect.parameters {
                let _ = writeln!(page, "  {}", effect_line(effect, parameter));
            }
        }
        page.push_str(&self.scale_line());
        if let Some(sentence) = physical(together.physical) {
            let _ = writeln!(page, "  {sentence}");
        }
        let _ = writeln!(page, "\n  {:<26}{:>13}{:>13}  unit", "misfit, rms", "without them", "with them");
        for (name, without, with, unit) in self.misfits() {
            let _ = writeln!(page, "  {name:<26}{:>13}{:>13}  {unit}", number(without), number(with));
        }
        page.push('\n');
        let latency = &together.latency;
        let how =
            if together.latency_named { "held as the kind that was named" } else { "estimated with them" };
        let _ = writeln!(
            page,
            "  actuation latency {:.1} +- {:.1} ms, {how}",
            1e3 * latency.total_s,
            1e3 * latency.std_s
        );
        page.push_str(&flight_lines(&self.quality.iter().collect::<Vec<_>>()));
        page
    }

    fn scale_line(&self) -> String {
        match self.together.scale.as_ref().map(|scale| (scale.name, &scale.value, scale.unit)) {
            Some((name, Finding::Determined { value, std }, unit)) => {
                format!("  {name} {value:.4e} +- {std:.1e} {unit} (identified; forces are on the scale of the weighed mass)\n")
            }
            Some((name, ..)) => format!("  {name} is not determined: forces are on the stated scale\n"),
            None => "  scale: the stated thrust is trusted (anchor = \"thrust\"); masses, forces and torques rest on it\n"
                .to_owned(),
        }
    }

    /// The model file: the vehicle with the effects.
    ///
    /// # Errors
    /// [`ConfigError`] where a value has no form in TOML.
    pub fn model_toml(&self, inputs: &[InputFile]) -> Result<String, ConfigError> {
        let together = &self.together;
        let mut text = vehicle_to_toml(&together.vehicle)?;
        text.push_str(&effect_tables(&together.acting));
        let ids: Vec<&str> = together.effects.iter().map(|effect| effect.effect.id()).collect();
        let _ = writeln!(text, "\n[identified]\nmethod = \"WEAK\"\nwith = {ids:?}");
        let _ = writeln!(text, "# what the flight did not determine keeps its nominal value in [body]");
        text.push_str(&identified_entries(&together.body, together.scale.as_ref()));
        let latency = &together.latency;
        if latency.std_s.is_finite() {
            let _ = writeln!(
                text,
                "latency = {{ value = {:e}, std = {:e}, unit = \"s\" }}",
                latency.total_s, latency.std_s
            );
        }
        let (names, rows) = correlations(&together.after);
        let _ = writeln!(text, "correlation_of = {names:?}\ncorrelation = [\n{}\n]", rows.join(",\n"));
        for effect in &together.effects {
            let _ = writeln!(text, "\n[identified.effects.{}]\nz = {:e}", effect.effect.id(), effect.z);
            for parameter in &effect.parameters {
                let _ = writeln!(text, "{}", model_line(parameter));
            }
        }
        text.push_str(&provenance(inputs));
        Ok(text)
    }
}

/// What is to be said of the inertia.
fn physical(of: Physical) -> Option<&'static str> {
    match of {
        Physical::AsEstimated => None,
        Physical::Moved => Some(
            "the estimate was not an inertia that a body can have; moved to the nearest that is, within its error",
        ),
        Physical::No => Some(
            "warning: no body has this inertia (one principal moment exceeds the sum of the others), by more than its error; left as \
             estimated. Are arms, thrust and torque per thrust as the vehicle file states them?",
        ),
    }
}

/// How sure an effect is.
fn evidence(effect: &EffectFound) -> String {
    let tried =
        if effect.tried > 1 { format!(" after {} forms were tried", effect.tried) } else { String::new() };
    let there = if effect.is_significant() { "" } else { "; not to be told from nothing" };
    format!("{} {:.1} standard errors from nothing{tried}{there}", effect.effect.sentence(), effect.z)
}

fn body_line(with: &Parameter, without: &Parameter, nominal: f64) -> String {
    let short = |finding: &Finding| match finding {
        Finding::Determined { value, .. } | Finding::Given { value } => number(*value),
        Finding::NotDetermined { .. } => "-".to_owned(),
    };
    let (value, std) = match &with.finding {
        Finding::Determined { value, std } => (number(*value), number(*std)),
        Finding::Given { value } => (number(*value), "(weighed)".to_owned()),
        Finding::NotDetermined { reason } => return format!("{:<34} not determined: {reason}", with.name),
    };
    format!(
        "{:<34}{value:>13}{std:>13}{:>15}{:>12}  {}",
        with.name,
        short(&without.finding),
        number(nominal),
        with.unit
    )
}

/// What is asked for beyond what physics allows.
fn beyond(parameter: &ParameterFound, wanted: f64, std: f64) -> String {
    let (least, most) = parameter.plausible;
    let away = if wanted < least { least - wanted } else { wanted - most };
    let what = if away > 3.0 * std { "that is not this effect" } else { "the bound is within the error" };
    format!(
        "the flight asks for {wanted:.3e} +- {std:.1e}, physics allows {} to {}: {what}",
        compact(least),
        compact(most)
    )
}

fn effect_line(effect: &EffectFound, parameter: &ParameterFound) -> String {
    let name = format!("{}.{}", effect.effect.id(), parameter.name);
    let unit = parameter.unit;
    match &parameter.found {
        Found::Determined { value, std } => {
            format!("{name:<34}{:>13}{:>13}{:>15}{:>12}  {unit}", number(*value), number(*std), "", "")
        }
        Found::AtBound { value, wanted, std } => {
            format!(
                "{name:<34}{:>13}{:>13}  {unit}; {}",
                number(*value),
                number(*std),
                beyond(parameter, *wanted, *std)
            )
        }
        Found::Given { value, why } => {
            format!("{name:<34}{:>13}{:>13}  {unit}; {why}", number(*value), "(set)")
        }
        Found::NotDetermined { reason, .. } => format!("{name:<34} not determined: {reason}"),
    }
}

fn effect_value(effect: &EffectFound) -> EffectValue {
    EffectValue {
        id: effect.effect.id(),
        sentence: effect.effect.sentence(),
        z: effect.z,
        significant: effect.is_significant(),
        tried: effect.tried,
        parameters: effect.parameters.iter().map(parameter_value).collect(),
    }
}

fn parameter_value(parameter: &ParameterFound) -> ParameterValue {
    let ParameterFound { name, unit, found, .. } = parameter;
    let empty = ParameterValue {
        name,
        value: None,
        std: None,
        unit,
        status: "",
        wanted: None,
        held_at: None,
        reason: None,
    };
    match found {
        Found::Determined { value, std } => {
            ParameterValue { value: Some(*value), std: Some(*std), status: "determined", ..empty }
        }
        Found::AtBound { value, wanted, std } => ParameterValue {
            value: Some(*value),
            std: Some(*std),
            wanted: Some(*wanted),
            status: "at_bound",
            reason: Some(beyond(parameter, *wanted, *std)),
            ..empty
        },
        Found::Given { value, why } => ParameterValue {
            value: Some(*value),
            std: Some(0.0),
            status: "given",
            reason: Some(why.clone()),
            ..empty
        },
        Found::NotDetermined { held, reason } => ParameterValue {
            status: "not_determined",
            held_at: Some(*held),
            reason: Some(reason.clone()),
            ..empty
        },
    }
}

fn model_line(parameter: &ParameterFound) -> String {
    let ParameterFound { name, unit, found, .. } = parameter;
    match found {
        Found::Determined { value, std } => {
            format!("{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\" }}")
        }
        Found::AtBound { value, wanted, std } => format!(
            "{name} = {{ value = {value:e}, std = {std:e}, unit = \"{unit}\", status = \"at_bound\", wanted = {wanted:e} }}"
        ),
        Found::Given { value, why } => {
            format!(
                "{name} = {{ value = {value:e}, std = 0.0, unit = \"{unit}\", status = \"given\", reason = {why:?} }}"
            )
        }
        Found::NotDetermined { reason, .. } => {
            format!("{name} = {{ status = \"not_determined\", reason = {reason:?} }}")
        }
    }
}
