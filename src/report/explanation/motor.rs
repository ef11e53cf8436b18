//! Which motor a parameter means, in words.

use crate::diagnose::Named;
use crate::report::vehicle_drawing::motor_words;
use crate::study::ExplainStudy;

/// The autopilot's number of a motor and its place, where a parameter says which; no reader meets the index that it is in files.
pub(super) fn motor(study: &ExplainStudy, effect: &Named, parameter: &str) -> Option<String> {
    let place = study.motor_of(effect).filter(|_| study.motor_parameter(effect) == Some(parameter))?;
    Some(motor_words(study.vehicle().rotors.get(place)?, place))
}
