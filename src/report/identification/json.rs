//! The JSON document of `identify`.

use crate::estimate::{Identification, LatencyKind, NAMES, THETA};
use crate::report::thrust_source::thrust_name;
use crate::report::value::{Thrust, Value, thrust, values};
use crate::signals::Quality;
use crate::study::{IdentifyStudy, InputFile};
use crate::vehicle::Anchor;
use serde::Serialize;
use std::collections::BTreeMap;

use super::with_json::{With, with_values};
use super::words::verdict;

/// The JSON document of `identify`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IdentificationDocument {
    schema: u32,
    vehicle: String,
    anchor: &'static str,
    methods: BTreeMap<&'static str, BTreeMap<&'static str, Value>>,
    verdict: String,
    best: Best,
    #[serde(skip_serializing_if = "Option::is_none")]
    thrust: Option<Thrust>,
    condition_number: Option<f64>,
    scaled_condition_number: f64,
    latency: Option<LatencyValue>,
    trim_torque: TrimTorque,
    filter: Filter,
    data_quality: DataQuality,
    history: BTreeMap<&'static str, HistoryColumns>,
    notes: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    with: Option<With>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Best {
    method: &'static str,
    why: String,
    made_physical: bool,
    /// effects that were estimated together with them
    beside: Vec<&'static str>,
    parameters: BTreeMap<&'static str, Value>,
    /// names in the order of rows and columns
    correlation_of: [&'static str; THETA],
    correlation: Vec<Vec<Option<f64>>>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct LatencyValue {
    value: f64,
    std: f64,
    unit: &'static str,
    kind: &'static str,
    delay_taken_out_s: f64,
    lag_taken_out_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct TrimTorque {
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
    unit: &'static str,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Filter {
    cutoff_hz: f64,
    highest_harmonic_hz: Option<f64>,
    lambda_rad_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct DataQuality {
    inputs: Vec<InputFile>,
    flights: Vec<FlightQuality>,
    residual: BTreeMap<&'static str, f64>,
    explained: BTreeMap<&'static str, f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct FlightQuality {
    usable_s: f64,
    total_s: f64,
    excluded: String,
    thrust_from: &'static str,
    sources: Vec<SourceQuality>,
    offsets: Vec<OffsetQuality>,
    accelerometer_bias_z_m_s2: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct SourceQuality {
    quantity: String,
    message: &'static str,
    rate_hz: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct OffsetQuality {
    quantity: String,
    late_s: f64,
    std_s: Option<f64>,
    repaired: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct HistoryColumns {
    time_s: Vec<f64>,
    #[serde(flatten)]
    parameters: BTreeMap<&'static str, Vec<f64>>,
}

impl IdentificationDocument {
    /// The document of a study.
    #[must_use]
    pub fn new(study: &IdentifyStudy) -> Self {
        let identification = &study.identification;
        let best = &identification.best;
        Self {
            schema: 1,
            vehicle: study.vehicle.name.clone(),
            anchor: anchor_name(study.vehicle.anchor),
            methods: identification.methods.iter().map(|m| (m.method.name(), values(m))).collect(),
            verdict: verdict(study, &best.result),
            best: Best {
                method: best.method.name(),
                why: best.why.clone(),
                made_physical: best.made_physical,
                beside: study.beside.clone(),
                parameters: values(&best.result),
                correlation_of: NAMES,
                correlation: study.method_correlation().rows,
            },
            thrust: study.scale.as_ref().map(thrust),
            condition_number: identification.condition_number,
            scaled_condition_number: identification.scaled_condition_number,
            latency: latency_value(identification),
            trim_torque: trim_torque(identification),
            filter: Filter {
                cutoff_hz: identification.cutoff_hz,
                highest_harmonic_hz: identification.highest_harmonic_hz,
                lambda_rad_s: crate::signals::FilterPair::PAPER_LAMBDA_RAD_S,
            },
            data_quality: data_quality(study),
            history: history_columns(identification),
            notes: identification.notes.iter().map(ToString::to_string).collect(),
            with: study.with.as_ref().map(with_values),
        }
    }
}

fn anchor_name(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Thrust => "thrust",
        Anchor::Mass => "mass",
    }
}

fn kind_name(kind: LatencyKind) -> &'static str {
    match kind {
        LatencyKind::Undetermined => "undetermined",
        LatencyKind::Lag => "lag",
        LatencyKind::Delay => "delay",
        LatencyKind::Both { .. } => "lag_and_delay",
    }
}

fn latency_value(identification: &Identification) -> Option<LatencyValue> {
    let latency = identification.latency?;
    latency.total_s.is_finite().then(|| LatencyValue {
        value: latency.total_s,
        std: latency.std_s,
        unit: "s",
        kind: kind_name(latency.kind),
        delay_taken_out_s: identification.compensated.delay_s,
        lag_taken_out_s: identification.compensated.lag_s,
    })
}

fn trim_torque(identification: &Identification) -> TrimTorque {
    let [x, y, z] = identification.trim_torque_nm.map(|torque| torque.is_finite().then_some(torque));
    TrimTorque { x, y, z, unit: "N m" }
}

fn data_quality(study: &IdentifyStudy) -> DataQuality {
    let identification = &study.identification;
    let flights = study.flights.iter().zip(&identification.accelerometer_bias);
    let channels = identification.residual_channels.iter().copied();
    DataQuality {
        inputs: study.inputs.clone(),
        flights: flights.map(|(flight, bias)| flight_quality(&flight.quality, *bias)).collect(),
        residual: channels.clone().zip(identification.residual.iter().copied()).collect(),
        explained: channels.zip(identification.explained.iter().copied()).collect(),
    }
}

fn flight_quality(quality: &Quality, bias_z_m_s2: Option<f64>) -> FlightQuality {
    FlightQuality {
        usable_s: quality.usable.usable_s,
        total_s: quality.usable.total_s,
        excluded: quality.usable.summary(),
        thrust_from: thrust_name(quality.thrust_source),
        sources: quality
            .sources
            .iter()
            .map(|(quantity, message, rate_hz)| SourceQuality {
                quantity: format!("{quantity:?}"),
                message,
                rate_hz: *rate_hz,
            })
            .collect(),
        offsets: quality
            .offsets
            .iter()
            .map(|(quantity, offset)| OffsetQuality {
                quantity: format!("{quantity:?}"),
                late_s: offset.late_s,
                std_s: offset.std_s.is_finite().then_some(offset.std_s),
                repaired: offset.repaired,
            })
            .collect(),
        accelerometer_bias_z_m_s2: bias_z_m_s2,
    }
}

fn history_columns(identification: &Identification) -> BTreeMap<&'static str, HistoryColumns> {
    identification
        .histories
        .iter()
        .map(|(method, history)| {
            let column = |i: usize| history.theta.iter().map(|theta| theta[i]).collect();
            let parameters = NAMES.iter().enumerate().map(|(i, name)| (*name, column(i))).collect();
            (method.name(), HistoryColumns { time_s: history.time_s.clone(), parameters })
        })
        .collect()
}
