//! One flight against all models.

use crate::diagnose::holdout::WINDOWS_S;
use std::path::Path;

use super::closed_loop::closed_loop;
use super::comparisons::{playback_table, prediction_table};
use super::error_table::ErrorTable;
use super::model::Contender;
use super::result::ValidatedFlight;
use crate::compare::{PlaybackSettings, playback};
use crate::estimate::theta_of;
use crate::regression::{ZeroPhase, output_prediction_rms, paper_models};
use crate::signals::{Butterworth, ConditionSettings, Signals};
use crate::study::StudyError;
use crate::study::flight::Flight;

/// Cut-off of the low-pass under the regression models, Hz. All models are judged by the same signals; a higher one
/// compares noise.
pub(super) const CUTOFF_HZ: f64 = 5.0;

pub(super) fn flight(
    flight: &Flight,
    models: &[Contender],
    transient_s: f64,
) -> Result<ValidatedFlight, StudyError> {
    let path = flight.input.path.as_str();
    let _stage = tracing::info_span!("predict", path, models = models.len()).entered();
    let settings = ConditionSettings { transient_s: Some(transient_s), ..ConditionSettings::default() };
    // each model's own thrust law turns commands into thrusts
    let conditioned = models
        .iter()
        .map(|model| flight.conditioned((&model.vehicle, Path::new(&model.of.input.path)), &settings));
    let signals: Vec<Signals> = conditioned.collect::<Result<_, _>>()?;
    let refuse = |why: String| StudyError::File { file: flight.input.path.clone(), why };
    let Some(first) = signals.first() else {
        return Err(refuse("expected a model to compare with".to_owned()));
    };
    let span_s = span_s(first, transient_s).map_err(&refuse)?;
    let (closed_loop, flown_again) = closed_loop(flight, first, models, span_s);
    let mut tables = vec![closed_loop];
    tables.extend(predictions(models, &signals, span_s));
    tables.extend(WINDOWS_S.map(|window_s| played_back(models, &signals, window_s)));
    if tables.iter().all(|table| table.shown().is_empty()) {
        return Err(refuse(nothing_to_compare(&tables)));
    }
    let quality = first.quality.clone();
    Ok(ValidatedFlight { input: flight.input.clone(), span_s, tables, flown_again, quality })
}

/// The flight in the air without its beginning; an error says what is there.
fn span_s(signals: &Signals, transient_s: f64) -> Result<(f64, f64), String> {
    let airborne = signals.quality.airborne_s.first().copied();
    let airborne = airborne.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let end_s = signals.grid.time_s(signals.grid.count.saturating_sub(1)).min(airborne.1);
    let start_s = signals.grid.start_s.max(airborne.0) + transient_s;
    if end_s <= start_s {
        return Err(format!(
            "expected flight beyond the first {transient_s} s (--transient), the vehicle is in the air until {end_s:.1} s"
        ));
    }
    Ok((start_s, end_s))
}

fn played_back(models: &[Contender], signals: &[Signals], window_s: f64) -> ErrorTable {
    let settings = PlaybackSettings { window_s, ..PlaybackSettings::default() };
    let fits: Vec<_> = models
        .iter()
        .zip(signals)
        .map(|(model, signals)| {
            let played = playback((&model.predicting, &model.vehicle), signals, &settings);
            (model.of.name.clone(), played.map_err(|error| error.to_string()))
        })
        .collect();
    playback_table(window_s, &fits)
}

/// Each reason once.
fn nothing_to_compare(tables: &[ErrorTable]) -> String {
    let mut reasons: Vec<&str> = Vec::new();
    for why in tables.iter().flat_map(ErrorTable::remarks) {
        if !reasons.contains(&why) {
            reasons.push(why);
        }
    }
    format!("nothing to compare with: {}", reasons.join("; "))
}

/// (43) in both regression models.
fn predictions(models: &[Contender], signals: &[Signals], span_s: (f64, f64)) -> [ErrorTable; 2] {
    let mut columns = [Vec::new(), Vec::new()];
    for (model, signals) in models.iter().zip(signals) {
        let theta = theta_of(&model.vehicle.body);
        let built = Butterworth::new(CUTOFF_HZ, 1.0 / signals.grid.step_s)
            .ok_or_else(|| {
                let rate_hz = 1.0 / signals.grid.step_s;
                format!("the recording's {rate_hz:.0} Hz are too few for a low-pass at {CUTOFF_HZ} Hz")
            })
            .and_then(|filter| {
                let filter = ZeroPhase::Butterworth(filter);
                paper_models(signals, model.vehicle.gravity_m_s2, &filter).ok_or_else(|| lacking(signals))
            });
        let rms = built.map(|(standard, filtered)| {
            [&standard, &filtered].map(|regression| output_prediction_rms(regression, &theta, span_s))
        });
        for (index, column) in columns.iter_mut().enumerate() {
            let found = rms.clone().and_then(|both| {
                both[index].ok_or_else(|| {
                    format!("no usable stretch between {:.1} and {:.1} s is long enough", span_s.0, span_s.1)
                })
            });
            column.push((model.of.name.clone(), found));
        }
    }
    let title = |which| {
        format!("Output prediction error (43) of the {which} regression model, by mass and inertia alone")
    };
    [prediction_table(title("standard"), &columns[0]), prediction_table(title("filtered"), &columns[1])]
}

/// What the regression models need of a recording and this one does not hold.
fn lacking(signals: &Signals) -> String {
    let what = if signals.rate.is_none() {
        "body rates"
    } else {
        "vertical motion (an accelerometer, or attitude with velocity or position)"
    };
    format!("the recording holds no {what}: the regression models need it")
}
