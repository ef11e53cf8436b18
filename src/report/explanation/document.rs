//! The JSON document of `explain`.

use super::fit::{FitValues, fit_values};
use super::located::Located;
use super::prediction::ShownOn;
use super::story::{Story, body_values, rigid_body};
use crate::diagnose::{AXES, Along, CHANNEL_NAMES, Named};
use crate::report::InputFile;
use serde::Serialize;
use std::collections::BTreeMap;

/// The JSON document of `explain`.
#[derive(Debug, Clone, Serialize)]
pub struct ExplanationDocument {
    schema: u32,
    verdict: &'static str,
    answer: String,
    effects: Vec<EffectValue>,
    closest: Vec<EffectValue>,
    empirical: Option<EmpiricalValue>,
    localisation: Located,
    fit: FitValues,
    parameters: BTreeMap<&'static str, ParameterValue>,
    rigid_body: BTreeMap<&'static str, Moved>,
    latency: LatencyValue,
    lack_of_fit: Option<LackValue>,
    residual: BTreeMap<&'static str, ResidualValue>,
    detection_limits: Vec<LimitValue>,
    too_little_excitation: bool,
    data_quality: DataQuality,
    next_flight: Option<NextValue>,
    warnings: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
struct EffectValue {
    id: &'static str,
    sentence: String,
    parameters: Vec<ParameterOf>,
    evidence: EvidenceValue,
    confusable_with: Vec<&'static str>,
    /// standard deviations by which this flight tells them apart
    distinguishability: BTreeMap<&'static str, Option<f64>>,
}

#[derive(Debug, Clone, Serialize)]
struct ParameterOf {
    name: &'static str,
    value: f64,
    std: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct EvidenceValue {
    z: f64,
    gain_percent: f64,
    delta_bic: f64,
    p_value: f64,
}

/// A term without a mechanism: straight lines between the knots, zero outside.
#[derive(Debug, Clone, Serialize)]
struct EmpiricalValue {
    variable: &'static str,
    unit: &'static str,
    at: Vec<f64>,
    force_n: Vec<[f64; 3]>,
    frame: &'static str,
    gain_percent: f64,
}

#[derive(Debug, Clone, Serialize)]
struct ParameterValue {
    value: f64,
    std: Option<f64>,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct Moved {
    nominal: f64,
    before: f64,
    after: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct LatencyValue {
    total_s: f64,
    std_s: Option<f64>,
    delay_s: f64,
    lag_s: f64,
    named: bool,
}

#[derive(Debug, Clone, Serialize)]
struct LackValue {
    period_s: f64,
    periods: usize,
    p_value: f64,
    p_value_by_axis: BTreeMap<&'static str, f64>,
}

#[derive(Debug, Clone, Serialize)]
struct ResidualValue {
    before: f64,
    after: f64,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct LimitValue {
    id: &'static str,
    parameter: &'static str,
    limit: f64,
    /// on ordinary vehicles, of what shows only where the vehicle moves
    usual: Option<f64>,
    unit: &'static str,
}

#[derive(Debug, Clone, Serialize)]
struct DataQuality {
    inputs: Vec<InputFile>,
    holdout: Vec<InputFile>,
    flights: Vec<FlightValue>,
}

#[derive(Debug, Clone, Serialize)]
struct FlightValue {
    usable_s: f64,
    total_s: f64,
    excluded: String,
    thrust_from: &'static str,
    notes: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
struct NextValue {
    /// why there is none
    reason: Option<String>,
    seconds: Option<f64>,
    /// what it tells apart, in standard deviations
    pairs: Vec<NextPair>,
    /// what no trajectory tells apart, and why
    inseparable: Vec<String>,
}

#[derive(Debug, Clone, Serialize)]
struct NextPair {
    named: &'static str,
    /// null: how far it stands out of the noise
    other: Option<&'static str>,
    now: f64,
    after: f64,
}

impl ExplanationDocument {
    /// From the story.
    #[must_use]
    pub fn new(story: &Story) -> Self {
        Self {
            schema: 1,
            verdict: story.verdict().name(),
            answer: story.answer(),
            effects: effect_values(story, &story.effects),
            closest: effect_values(story, &story.closest),
            empirical: empirical(story),
            localisation: story.located.clone(),
            fit: fit_values(story),
            parameters: story
                .rigid_body()
                .into_iter()
                .map(|p| {
                    let std = p.std.is_finite().then_some(p.std);
                    (p.name, ParameterValue { value: p.value, std, unit: p.unit })
                })
                .collect(),
            rigid_body: moved(story),
            latency: latency(story),
            lack_of_fit: lack(story),
            residual: residual(story),
            detection_limits: limits(story),
            too_little_excitation: story.explanation.too_little_excitation,
            data_quality: data_quality(story),
            next_flight: next(story),
            warnings: story.given.warnings.clone(),
        }
    }
}

fn effect_values(story: &Story, effects: &[Named]) -> Vec<EffectValue> {
    effects
        .iter()
        .map(|effect| EffectValue {
            id: effect.id,
            sentence: format!("{}.", crate::diagnose::clause(effect, story.vehicle())),
            parameters: effect
                .parameters
                .iter()
                .map(|p| ParameterOf { name: p.name, value: p.value, std: p.std, unit: p.unit })
                .collect(),
            evidence: EvidenceValue {
                z: effect.strength.z,
                gain_percent: 100.0 * effect.strength.gain,
                delta_bic: story.delta_bic(effect),
                p_value: story.p_value(effect),
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

fn empirical(story: &Story) -> Option<EmpiricalValue> {
    let term = story.empirical.as_ref()?;
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

fn moved(story: &Story) -> BTreeMap<&'static str, Moved> {
    let nominal = body_values(&story.given.vehicle.body);
    let search = &story.explanation.search;
    rigid_body(&search.before)
        .iter()
        .zip(rigid_body(story.fitted()))
        .zip(nominal)
        .map(|((before, after), nominal)| {
            let moved = Moved { nominal, before: before.value, after: after.value, unit: after.unit };
            (after.name, moved)
        })
        .collect()
}

fn latency(story: &Story) -> LatencyValue {
    let latency = &story.explanation.search.latency;
    LatencyValue {
        total_s: latency.total_s,
        std_s: latency.std_s.is_finite().then_some(latency.std_s),
        delay_s: latency.parts.delay_s,
        lag_s: latency.parts.lag_s,
        named: story.latency_named(),
    }
}

fn lack(story: &Story) -> Option<LackValue> {
    let lack = story.explanation.lack_of_fit.as_ref()?;
    Some(LackValue {
        period_s: lack.period_s,
        periods: lack.periods,
        p_value: lack.p_least(),
        p_value_by_axis: CHANNEL_NAMES.into_iter().zip(lack.p_value).collect(),
    })
}

fn residual(story: &Story) -> BTreeMap<&'static str, ResidualValue> {
    let search = &story.explanation.search;
    let (before, after) = (search.before.weighted.sigma, search.after.weighted.sigma);
    CHANNEL_NAMES
        .into_iter()
        .take(AXES)
        .zip(before.into_iter().zip(after))
        .map(|(name, (before, after))| {
            let unit = if name.starts_with("force") { "N" } else { "N m" };
            (name, ResidualValue { before, after, unit })
        })
        .collect()
}

fn limits(story: &Story) -> Vec<LimitValue> {
    let limits = story.explanation.limits.iter();
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

fn next(story: &Story) -> Option<NextValue> {
    Some(match story.next.as_ref()? {
        Err(why) => {
            NextValue { reason: Some(why.clone()), seconds: None, pairs: Vec::new(), inseparable: Vec::new() }
        }
        Ok(next) => NextValue {
            reason: None,
            seconds: Some(next.seconds),
            inseparable: next.inseparable.iter().map(ToString::to_string).collect(),
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

fn data_quality(story: &Story) -> DataQuality {
    DataQuality {
        inputs: story.given.inputs.clone(),
        holdout: match &story.shown_on {
            ShownOn::Flights(inputs) => inputs.clone(),
            _ => Vec::new(),
        },
        flights: story
            .given
            .quality
            .iter()
            .map(|quality| FlightValue {
                usable_s: quality.usable.usable_s,
                total_s: quality.usable.total_s,
                excluded: quality.usable.summary(),
                thrust_from: crate::report::identification::thrust_name(quality.thrust_source),
                notes: quality.notes.clone(),
            })
            .collect(),
    }
}
