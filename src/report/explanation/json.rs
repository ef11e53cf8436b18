//! The JSON document of `explain`.

use super::along::AlongValue;
use super::answer::answer;
use super::effect_json::{EffectValue, TraceValue, effect_values, trace};
use super::fit_json::{FitValues, fit_values};
use super::turning_json::TurningValue;
use crate::diagnose::experiment::Inseparable;
use crate::diagnose::{Along, CHANNEL_NAMES};
use crate::note::Note;
use crate::report::thrust_source::thrust_name;
use crate::report::value::{Thrust, thrust};
use crate::study::{AxisFit, BodyParameter, ExplainStudy, FlightLimit, InputFile, Located};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON document of `explain`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ExplanationDocument {
    /// version of the document
    #[schemars(extend("const" = 1))]
    schema: u32,
    verdict: &'static str,
    answer: String,
    /// why the answer is doubtful; names and sizes are then of a flight, a log or a vehicle file that something speaks against
    doubts: Vec<String>,
    /// why the flights tell little, by the way they were flown; no name is certain then
    limited: Vec<String>,
    effects: Vec<EffectValue>,
    traces: Vec<TraceValue>,
    closest: Vec<EffectValue>,
    empirical: Option<EmpiricalValue>,
    /// only where such a term was left out, because what was not used is predicted worse with it
    #[serde(skip_serializing_if = "Option::is_none")]
    empirical_left_out: Option<LeftOutValue>,
    #[serde(flatten)]
    turning: TurningValue,
    localisation: Located,
    #[serde(rename = "fit")]
    prediction: FitValues,
    parameters: BTreeMap<&'static str, ParameterValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    thrust: Option<Thrust>,
    rigid_body: BTreeMap<&'static str, Moved>,
    latency: LatencyValue,
    lack_of_fit: Option<LackValue>,
    residual: BTreeMap<&'static str, ResidualValue>,
    detection_limits: Vec<LimitValue>,
    too_little_excitation: bool,
    data_quality: DataQuality,
    next_flight: Option<NextValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    flights_together: Option<AlongValue>,
    warnings: Vec<String>,
}

/// A term without a mechanism: linear between the knots, zero outside.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct EmpiricalValue {
    variable: &'static str,
    unit: &'static str,
    at: Vec<f64>,
    force_n: Vec<[f64; 3]>,
    frame: &'static str,
    gain_percent: f64,
}

/// By how much errors over 0.5 s are larger with a term, mean over the quantities.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LeftOutValue {
    variable: &'static str,
    worse_percent: f64,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ParameterValue {
    value: Option<f64>,
    std: Option<f64>,
    unit: &'static str,
    /// why there is no value
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Moved {
    nominal: f64,
    /// by the rigid body alone; null where the flights do not determine it
    before: Option<f64>,
    before_std: Option<f64>,
    after: Option<f64>,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LatencyValue {
    total_s: Option<f64>,
    std_s: Option<f64>,
    delay_s: Option<f64>,
    lag_s: Option<f64>,
    named: bool,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LackValue {
    period_s: f64,
    periods: usize,
    p_value: f64,
    p_value_by_axis: BTreeMap<&'static str, f64>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ResidualValue {
    before: f64,
    after: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct LimitValue {
    id: &'static str,
    parameter: &'static str,
    limit: f64,
    /// size on ordinary vehicles, for effects that appear only in motion
    usual: Option<f64>,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct DataQuality {
    inputs: Vec<InputFile>,
    holdout: Vec<InputFile>,
    flights: Vec<FlightValue>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct FlightValue {
    usable_s: f64,
    total_s: f64,
    excluded: String,
    thrust_from: &'static str,
    notes: Vec<String>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct NextValue {
    /// the reason why there is none
    reason: Option<String>,
    seconds: Option<f64>,
    /// pairs that it separates, in standard deviations
    pairs: Vec<NextPair>,
    /// pairs that no trajectory separates, with the reason
    inseparable: Vec<String>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct NextPair {
    named: &'static str,
    /// null: the distance is from zero
    other: Option<&'static str>,
    now: f64,
    after: f64,
}

impl ExplanationDocument {
    /// The document of a study.
    #[must_use]
    pub fn new(study: &ExplainStudy) -> Self {
        Self {
            schema: 1,
            verdict: study.verdict().name(),
            answer: answer(study),
            doubts: study.doubts(),
            limited: study.limited().iter().map(FlightLimit::words).collect(),
            effects: effect_values(study, &study.effects),
            traces: study.explanation.slight.iter().map(|slight| trace(study, slight)).collect(),
            closest: effect_values(study, &study.closest),
            empirical: empirical(study),
            empirical_left_out: study.left_out_force.map(|force| LeftOutValue {
                variable: force.along.name(),
                worse_percent: force.worse_percent,
            }),
            turning: TurningValue::of(study),
            localisation: study.located.clone(),
            prediction: fit_values(study),
            parameters: study
                .body()
                .into_iter()
                .map(|p| {
                    let known = p.not_determined.is_none();
                    let std = (known && p.after.std.is_finite()).then_some(p.after.std);
                    let value = known.then_some(p.after.value);
                    (p.name, ParameterValue { value, std, unit: p.unit, reason: p.not_determined })
                })
                .collect(),
            thrust: study.scale().as_ref().map(thrust),
            rigid_body: moved(study),
            latency: latency(study),
            lack_of_fit: lack(study),
            residual: residual(study),
            detection_limits: limits(study),
            too_little_excitation: study.explanation.too_little_excitation,
            data_quality: data_quality(study),
            next_flight: next_value(study),
            flights_together: study.along.as_ref().map(|along| AlongValue::new(study, along)),
            warnings: study.notes.iter().map(Note::sentence).collect(),
        }
    }
}

fn empirical(study: &ExplainStudy) -> Option<EmpiricalValue> {
    let term = study.empirical.as_ref()?;
    Some(EmpiricalValue {
        variable: term.along.name(),
        unit: term.along.unit(),
        at: term.knots.clone(),
        force_n: term.force_n.iter().map(|force| [force.x, force.y, force.z]).collect(),
        frame: match term.along {
            Along::Position(_) => "world",
            Along::Velocity(_) => "body",
        },
        gain_percent: 100.0 * term.gain,
    })
}

fn moved(study: &ExplainStudy) -> BTreeMap<&'static str, Moved> {
    let moved = |p: BodyParameter| {
        let after = p.not_determined.is_none().then_some(p.after.value);
        let before = Some(p.before).filter(|_| p.before_not_determined.is_none());
        let value = Moved {
            nominal: p.nominal,
            before: before.map(|of| of.value),
            before_std: before.map(|of| of.std).filter(|std| std.is_finite()),
            after,
            unit: p.unit,
        };
        (p.name, value)
    };
    study.body().into_iter().map(moved).collect()
}

fn latency(study: &ExplainStudy) -> LatencyValue {
    let latency = study.latency();
    let determined = |value: f64| latency.is_determined().then_some(value);
    LatencyValue {
        total_s: determined(latency.total_s),
        std_s: determined(latency.std_s),
        delay_s: determined(latency.parts.delay_s),
        lag_s: determined(latency.parts.lag_s),
        named: study.latency_named(),
    }
}

fn lack(study: &ExplainStudy) -> Option<LackValue> {
    let lack = study.explanation.lack_of_fit.as_ref()?;
    Some(LackValue {
        period_s: lack.period_s,
        periods: lack.periods,
        p_value: lack.p_least(),
        p_value_by_axis: CHANNEL_NAMES.into_iter().zip(lack.p_value).collect(),
    })
}

fn residual(study: &ExplainStudy) -> BTreeMap<&'static str, ResidualValue> {
    let value = |of: AxisFit| ResidualValue { before: of.before, after: of.after, unit: of.unit };
    study.residual().into_iter().map(|of| (of.name, value(of))).collect()
}

fn limits(study: &ExplainStudy) -> Vec<LimitValue> {
    let limits = study.explanation.limits.iter();
    limits
        .map(|l| LimitValue {
            id: l.id,
            parameter: l.parameter,
            limit: l.limit,
            usual: l.usual,
            unit: l.unit,
        })
        .collect()
}

fn next_value(study: &ExplainStudy) -> Option<NextValue> {
    Some(match study.next_flight.as_ref()? {
        Err(why) => NextValue {
            reason: Some(why.to_string()),
            seconds: None,
            pairs: Vec::new(),
            inseparable: Vec::new(),
        },
        Ok(next) => NextValue {
            reason: None,
            seconds: Some(next.seconds),
            inseparable: next.inseparable.iter().map(inseparable).collect(),
            pairs: next
                .pairs
                .iter()
                .map(|pair| NextPair {
                    named: pair.named,
                    other: pair.other,
                    now: pair.now,
                    after: pair.after,
                })
                .collect(),
        },
    })
}

/// With the identifiers of the effects, as the pairs have them.
fn inseparable(of: &Inseparable) -> String {
    format!("no trajectory separates {} from {}: {}", of.named, of.other, of.why)
}

fn data_quality(study: &ExplainStudy) -> DataQuality {
    DataQuality {
        inputs: study.given.inputs.clone(),
        holdout: study.held_out_inputs().to_vec(),
        flights: study
            .given
            .quality
            .iter()
            .map(|quality| FlightValue {
                usable_s: quality.usable.usable_s,
                total_s: quality.usable.total_s,
                excluded: quality.usable.summary(),
                thrust_from: thrust_name(quality.thrust_source),
                notes: quality.notes.iter().map(ToString::to_string).collect(),
            })
            .collect(),
    }
}
