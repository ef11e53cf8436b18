//! The fit before and after as JSON, with all values of the report's tables.

use super::no_model::by_model_file;
use crate::compare::SIGNALS;
use crate::diagnose::holdout::{AtEnd, Compared, HoldoutFit, OpenLoop};
use crate::diagnose::{AXES, CHANNEL_NAMES};
use crate::note::Note;
use crate::study::{ExplainStudy, Predicted, QUANTITIES, ValidationData, no_model_in};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// The `fit` of the JSON document.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct FitValues {
    identify: PairValue,
    holdout: PairValue,
    shown_on: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    held_back_from_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

/// Over windows of 0.5 s, then everything.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct PairValue {
    /// by a state that does not change
    unchanged: Option<FitValue>,
    before: Option<FitValue>,
    after: Option<FitValue>,
    /// quantities that a state that does not change predicts better over 0.5 s
    worse_than_unchanged: Vec<&'static str>,
    /// error that white noise of the sensors alone would cause
    floor: Option<FitValue>,
    windows: Option<usize>,
    improvement_percent: Option<f64>,
    improvement_range_percent: Option<(f64, f64)>,
    /// one for each length of window
    open_loop: Vec<WindowValue>,
    /// the same with `model.toml` as it is, where the errors above are with more than that: the load of each flight, an empirical force
    #[serde(skip_serializing_if = "Option::is_none")]
    as_written: Option<Vec<WindowValue>>,
    #[serde(flatten)]
    shown: Option<ShownValue>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct FitValue {
    position_m: Option<f64>,
    velocity_m_s: Option<f64>,
    attitude_rad: Option<f64>,
    rates_rad_s: Option<f64>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
struct WindowValue {
    window_s: f64,
    windows: usize,
    /// quantities that a state that does not change predicts better over this window, or at its end
    worse_than_unchanged: Vec<&'static str>,
    errors: BTreeMap<&'static str, ComparedValue>,
}

/// Values of hold-out flights only.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ShownValue {
    weak_residual: BTreeMap<&'static str, ComparedValue>,
    /// `None` where it was not flown, or left the flight
    closed_loop: Option<BTreeMap<&'static str, ComparedValue>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_closed_loop: Option<String>,
    own_parameters: BTreeMap<String, OwnValue>,
    /// the reason why these cannot be flights of the identified vehicle
    other_vehicle: Option<String>,
    notes: Vec<String>,
}

/// Root mean square errors with 95 % bootstrap intervals over blocks of the flight.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct ComparedValue {
    #[serde(skip_serializing_if = "Option::is_none")]
    unchanged: Option<f64>,
    before: f64,
    before_range: Option<(f64, f64)>,
    after: f64,
    after_range: Option<(f64, f64)>,
    floor: Option<f64>,
    improvement_percent: f64,
    improvement_range_percent: Option<(f64, f64)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_end: Option<AtEndValue>,
    unit: &'static str,
}

/// Mean size of the error at the end of the windows.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct AtEndValue {
    unchanged: f64,
    before: f64,
    after: f64,
}

/// A parameter as identified and from the hold-out alone.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct OwnValue {
    identified: f64,
    identified_std: f64,
    own: f64,
    own_std: f64,
    sigmas: f64,
    unit: &'static str,
}

pub(super) fn fit_values(study: &ExplainStudy) -> FitValues {
    let (held_back_from_s, reason) = match &study.shown_on {
        ValidationData::Flights(_) | ValidationData::LeftOut { .. } => (None, None),
        ValidationData::HeldBack { from_s, .. } => (Some(*from_s), None),
        ValidationData::Nothing { reason } => (None, Some(reason.clone())),
    };
    let mut holdout = pair(study.holdout.as_ref());
    holdout.shown = study.shown.as_ref().map(shown);
    holdout.as_written = by_model_file(study).map(|written| written.open_loop.iter().map(window).collect());
    if study.other_vehicle().is_some() {
        // a gain on another vehicle is none
        (holdout.improvement_percent, holdout.improvement_range_percent) = (None, None);
    }
    FitValues {
        identify: pair(study.identify.as_ref()),
        holdout,
        shown_on: match study.shown_on {
            ValidationData::Flights(_) => "holdout",
            ValidationData::HeldBack { .. } => "held_back",
            ValidationData::LeftOut { .. } => "left_out",
            ValidationData::Nothing { .. } => "nothing",
        },
        held_back_from_s,
        reason,
    }
}

fn pair(predicted: Option<&Predicted>) -> PairValue {
    let half = predicted.map(Predicted::half_second);
    let windows = predicted.and_then(|of| of.at_half_second().map(|of| of.windows));
    let each = |pick: &dyn Fn(&Compared) -> Option<f64>| {
        let [position_m, velocity_m_s, attitude_rad, rates_rad_s] =
            half?.map(|of| of.as_ref().and_then(pick));
        Some(FitValue { position_m, velocity_m_s, attitude_rad, rates_rad_s })
    };
    PairValue {
        unchanged: each(&|of| of.unchanged.map(|of| of.value)),
        worse_than_unchanged: predicted.map_or_else(Vec::new, Predicted::worse_than_unchanged),
        before: each(&|of| Some(of.before.value)),
        after: each(&|of| Some(of.after.value)),
        floor: each(&|of| of.floor),
        windows,
        improvement_percent: predicted.and_then(Predicted::improvement),
        improvement_range_percent: predicted.and_then(|of| of.improvement_percent?.range),
        open_loop: predicted.map_or_else(Vec::new, |of| of.open_loop.iter().map(window).collect()),
        as_written: None,
        shown: None,
    }
}

fn window(of: &OpenLoop) -> WindowValue {
    const KEYS: [&str; 4] = ["position", "velocity", "attitude", "rates"];
    let errors = of.quantities().into_iter().zip(KEYS.into_iter().zip(QUANTITIES));
    let worse = QUANTITIES.into_iter().zip(no_model_in(of)).filter(|(_, worse)| *worse);
    WindowValue {
        window_s: of.window_s,
        windows: of.windows,
        worse_than_unchanged: worse.map(|((name, _), _)| name).collect(),
        errors: errors
            .filter_map(|(of, (key, (_, unit)))| Some((key, compared(of.as_ref()?, unit))))
            .collect(),
    }
}

fn shown(of: &HoldoutFit) -> ShownValue {
    let weak = of.weak.iter().zip(CHANNEL_NAMES).take(AXES);
    let (closed_loop, no_closed_loop) = match &of.closed_loop {
        Ok(flown) => {
            let signals = flown.signals.iter().zip(SIGNALS);
            let each = signals.filter_map(|(of, (name, unit))| Some((name, compared(of.as_ref()?, unit))));
            (Some(each.collect()), None)
        }
        Err(why) => (None, Some(why.clone())),
    };
    ShownValue {
        weak_residual: weak
            .filter_map(|(of, name)| {
                let unit = if name.starts_with("force") { "N" } else { "N m" };
                Some((name, compared(of.as_ref()?, unit)))
            })
            .collect(),
        closed_loop,
        no_closed_loop,
        own_parameters: of
            .agreement
            .iter()
            .map(|of| {
                let value = OwnValue {
                    identified: of.identified,
                    identified_std: of.identified_std,
                    own: of.held_out,
                    own_std: of.held_out_std,
                    sigmas: of.sigmas(),
                    unit: of.unit,
                };
                (of.name.clone(), value)
            })
            .collect(),
        other_vehicle: of.other_vehicle.as_ref().map(|other| other.reason.clone()),
        notes: of.notes.iter().map(Note::sentence).collect(),
    }
}

fn compared(of: &Compared, unit: &'static str) -> ComparedValue {
    ComparedValue {
        unchanged: of.unchanged.map(|of| of.value),
        before: of.before.value,
        before_range: of.before.range,
        after: of.after.value,
        after_range: of.after.range,
        floor: of.floor,
        improvement_percent: of.improvement_percent.value,
        improvement_range_percent: of.improvement_percent.range,
        at_end: of.at_end.map(|AtEnd { unchanged, before, after }| AtEndValue { unchanged, before, after }),
        unit,
    }
}
