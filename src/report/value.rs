//! Identified values in JSON.

use crate::estimate::{Finding, MethodResult, ThrustScale};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A number with its standard error, or the reason why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct Value {
    value: Option<f64>,
    std: Option<f64>,
    unit: &'static str,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

pub(super) fn values(result: &MethodResult) -> BTreeMap<&'static str, Value> {
    result.parameters.iter().map(|p| (p.name, value(&p.finding, p.unit))).collect()
}

fn value(finding: &Finding, unit: &'static str) -> Value {
    let empty = Value { value: None, std: None, unit, status: "", reason: None };
    match finding {
        Finding::Determined { value, std } => {
            Value { value: Some(*value), std: Some(*std), status: "determined", ..empty }
        }
        Finding::Given { value } => Value { value: Some(*value), std: Some(0.0), status: "given", ..empty },
        Finding::NotDetermined { reason } => {
            Value { status: "not_determined", reason: Some(reason.clone()), ..empty }
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct Thrust {
    name: &'static str,
    #[serde(flatten)]
    value: Value,
    factor: Value,
}

pub(super) fn thrust(scale: &ThrustScale) -> Thrust {
    let ThrustScale { name, unit, factor, .. } = scale;
    Thrust { name, value: value(&scale.value, unit), factor: value(factor, "-") }
}
