//! What the model does not predict better than a state that does not change, and a force that makes predictions worse.

use crate::diagnose::{Along, Verdict};
use crate::report::number::significant;
use crate::study::{ExplainStudy, Predicted, ValidationData};
use crate::text::list;
use crate::vehicle::AXIS_NAMES;

/// Quantities with their horizons, as `velocity (over 0.5 and 1 s) and attitude (over 1 s)`; `None` where the model is better in all.
fn not_predicted(predicted: &Predicted) -> Option<String> {
    let seconds = |windows_s: &[f64]| list(&windows_s.iter().map(f64::to_string).collect::<Vec<_>>());
    let each = predicted.no_model_of().into_iter();
    let each: Vec<String> =
        each.map(|(name, windows_s)| format!("{name} (over {} s)", seconds(&windows_s))).collect();
    (!each.is_empty()).then(|| list(&each))
}

/// A sentence of the answer: it holds over 0.5 s, or over several horizons. Empty where it does not.
pub(super) fn no_model(study: &ExplainStudy) -> String {
    let (predicted, on) = match &study.holdout {
        Some(holdout) => (Some(by_model_file(study).unwrap_or(holdout)), study.shown_on.words()),
        None => (study.identify.as_ref(), "the flights that were explained"),
    };
    let told = predicted.filter(|predicted| predicted.is_no_model()).and_then(not_predicted);
    let other = match (study.other_vehicle(), &study.shown_on) {
        (None, _) => "",
        // the vehicle is one throughout a flight
        (Some(_), ValidationData::HeldBack { .. }) => ", in which something changed,",
        (Some(_), _) => ", which is of another or a changed vehicle, or has more in it,",
    };
    // all other errors of the answer are with the load
    let without = if study.as_written.is_some() {
        " as it is in model.toml, without the load of that flight,"
    } else {
        ""
    };
    told.map_or_else(String::new, |what| {
        format!(
            " On {on}{other} the model{without} is not usable for prediction of {what}: a state that does not change has smaller errors."
        )
    })
}

/// The errors of the model as it is written, where they were measured with an empirical force beside its effects.
pub(super) fn written(study: &ExplainStudy) -> Option<&Predicted> {
    study.without_empirical.as_ref().filter(|_| study.verdict() == Verdict::PartlyExplained)
}

/// The errors on the hold-out with the model file as it is, where all others are with more than that: the load of each flight, or an
/// empirical force.
pub(super) fn by_model_file(study: &ExplainStudy) -> Option<&Predicted> {
    study.as_written.as_ref().or_else(|| written(study))
}

/// A line below a table of errors, at all horizons; `None` where the model is better in all.
pub(super) fn no_model_line(predicted: &Predicted) -> Option<String> {
    let what = not_predicted(predicted)?;
    Some(format!("no model for prediction of {what}: a state that does not change has smaller errors"))
}

/// A sentence on an empirical force that was left out; empty where none was.
pub(super) fn left_out_force(study: &ExplainStudy) -> String {
    study.left_out_force.map_or_else(String::new, |force| {
        format!(
            " An empirical force that depends on {} makes the 0.5 s errors on {} {} % larger in the mean, so no model has it.",
            spoken_along(force.along),
            study.shown_on.words(),
            significant(force.worse_percent, 2)
        )
    })
}

/// The quantity on which an empirical term depends, in words.
pub(super) fn spoken_along(along: Along) -> String {
    match along {
        Along::Position(axis) => format!("world {}", AXIS_NAMES[axis.min(2)]),
        Along::Velocity(axis) => format!("the velocity along body {}", AXIS_NAMES[axis.min(2)]),
    }
}
