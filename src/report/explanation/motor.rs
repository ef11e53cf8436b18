//! Which motor a parameter means, in words.

use crate::diagnose::{Named, NamedParameter};
use crate::report::number::{spoken, with_error};
use crate::study::ExplainStudy;

/// The autopilot's number of a motor and its place, where a parameter says which; no reader meets the index that it is in files.
pub(super) fn motor(study: &ExplainStudy, effect: &Named, parameter: &str) -> Option<String> {
    let place = study.motor_of(effect).filter(|_| study.motor_parameter(effect) == Some(parameter))?;
    Some(study.vehicle().motor_words(place))
}

/// The values of an effect with their standard errors, on one line.
pub(super) fn sizes(study: &ExplainStudy, effect: &Named) -> String {
    let size = |p: &NamedParameter| match motor(study, effect, p.name) {
        Some(motor) => motor,
        None => format!("{} {} {}", p.name, with_error(p.value, p.std), spoken(p.unit)).trim_end().to_owned(),
    };
    effect.parameters.iter().map(size).collect::<Vec<_>>().join(", ")
}
