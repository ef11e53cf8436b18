//! Named effects in the JSON document of `explain`.

use crate::diagnose::{Materiality, Named, NamedParameter, Slight};
use crate::study::ExplainStudy;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A named effect.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct EffectValue {
    id: &'static str,
    sentence: String,
    parameters: Vec<ParameterOf>,
    evidence: EvidenceValue,
    confusable_with: Vec<&'static str>,
    /// their distance in this flight, standard deviations
    distinguishability: BTreeMap<&'static str, Option<f64>>,
}

/// Certain, and too small to matter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct TraceValue {
    id: &'static str,
    parameters: Vec<ParameterOf>,
    z: f64,
    /// of its own part, root mean square
    #[serde(skip_serializing_if = "Option::is_none")]
    of_weight_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    of_torque_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    of_misfit_percent: Option<f64>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ParameterOf {
    name: &'static str,
    value: f64,
    std: f64,
    unit: &'static str,
    /// of the value that says which rotor: the autopilot's number, from 1
    #[serde(skip_serializing_if = "Option::is_none")]
    motor: Option<usize>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct EvidenceValue {
    z: f64,
    gain_percent: f64,
    delta_bic: f64,
    p_value: f64,
}

/// Effects with their values and evidence.
pub(super) fn effect_values(study: &ExplainStudy, effects: &[Named]) -> Vec<EffectValue> {
    effects
        .iter()
        .map(|effect| EffectValue {
            id: effect.id,
            sentence: format!("{}.", crate::diagnose::clause(effect, study.vehicle())),
            parameters: parameters(study, effect),
            evidence: EvidenceValue {
                z: effect.strength.z,
                gain_percent: 100.0 * effect.strength.gain,
                delta_bic: study.delta_bic(effect),
                p_value: study.p_value(effect),
            },
            confusable_with: effect.confusable_with.iter().map(|other| other.id).collect(),
            distinguishability: effect
                .confusable_with
                .iter()
                .map(|other| (other.id, other.distinguishability))
                .collect(),
        })
        .collect()
}

/// What is certain, and too small to matter.
pub(super) fn trace(study: &ExplainStudy, slight: &Slight) -> TraceValue {
    let percent = |of: fn(&Materiality) -> f64| slight.materiality.as_ref().map(|m| 100.0 * of(m));
    TraceValue {
        id: slight.effect.id,
        parameters: parameters(study, &slight.effect),
        z: slight.effect.strength.z,
        of_weight_percent: percent(|of| of.force),
        of_torque_percent: percent(|of| of.torque),
        of_misfit_percent: percent(|of| of.misfit),
    }
}

fn parameters(study: &ExplainStudy, effect: &Named) -> Vec<ParameterOf> {
    let which = study.motor_parameter(effect);
    let motor = |name| study.motor_of(effect).filter(|_| which == Some(name)).map(|index| index + 1);
    let one = |&NamedParameter { name, value, std, unit }: &NamedParameter| ParameterOf {
        name,
        value,
        std,
        unit,
        motor: motor(name),
    };
    effect.parameters.iter().map(one).collect()
}
