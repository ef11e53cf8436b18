//! The part of the JSON document of `identify` on requested effects.

use crate::diagnose::joint::{EffectFound, Found, ParameterFound, Physical};
use crate::report::thrust_source::thrust_name;
use crate::report::value::{Thrust, Value, thrust, values};
use crate::study::{Correlation, WithEffects};
use serde::Serialize;
use std::collections::BTreeMap;

use super::words::{beyond, physical};

/// The `with` of the JSON document.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct With {
    effects: Vec<EffectValue>,
    parameters: BTreeMap<&'static str, Value>,
    parameters_without: BTreeMap<&'static str, Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    thrust: Option<Thrust>,
    latency: Latency,
    misfit: BTreeMap<&'static str, MisfitValue>,
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
    /// standard errors from zero, with an allowance for the number of tried forms
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
    value: Option<f64>,
    std: Option<f64>,
    unit: &'static str,
    delay_s: Option<f64>,
    lag_s: Option<f64>,
    /// whether it is one of the requested effects
    named: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct MisfitValue {
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

/// As JSON.
pub(super) fn with_values(with: &WithEffects) -> With {
    let joint = &with.joint;
    let latency = &joint.latency;
    let determined = |value: f64| latency.is_determined().then_some(value);
    let Correlation { names: correlation_of, rows: correlation } = Correlation::of_fit(&joint.after);
    With {
        effects: joint.effects.iter().map(effect_value).collect(),
        parameters: values(&joint.body),
        parameters_without: values(&joint.body_before),
        thrust: joint.scale.as_ref().map(thrust),
        latency: Latency {
            value: determined(latency.total_s),
            std: determined(latency.std_s),
            unit: "s",
            delay_s: determined(latency.parts.delay_s),
            lag_s: determined(latency.parts.lag_s),
            named: joint.latency_named,
        },
        misfit: with
            .misfits()
            .into_iter()
            .map(|of| (of.name, MisfitValue { without: of.without, with: of.with, unit: of.unit }))
            .collect(),
        made_physical: joint.physical == Physical::Moved,
        warnings: physical(joint.physical).into_iter().collect(),
        correlation_of,
        correlation,
        flights: with
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
        Found::AtBound { value, unbounded, std } => ParameterValue {
            value: Some(*value),
            std: Some(*std),
            wanted: Some(*unbounded),
            status: "at_bound",
            reason: Some(beyond(parameter, *unbounded, *std)),
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
