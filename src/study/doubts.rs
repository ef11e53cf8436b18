//! Why an answer is doubtful.

use crate::estimate::{Contradiction, contradicts_file};
use crate::note::{About, Note};
use crate::signals::Quality;
use crate::vehicle::Vehicle;

/// The rotors of the vehicle file are not those of the autopilot.
const OTHER_ROTORS: &str = "the rotors of the vehicle file contradict the autopilot's parameters";

/// Streams that do not go together, or not with the rotors; which, is a warning.
const CONTRADICTION: &str = "the recorded motion does not go with the rotors of the vehicle file, or recorded streams contradict each other (see the warnings)";

/// Flights of one answer that are of two vehicles.
pub(super) const TWO_VEHICLES: &str =
    "the flights given together differ by more than flights of one vehicle do";

/// Largest ratio of an estimated mass to that of the vehicle file, or its inverse, without a note: a battery or a small payload.
const ORDINARY_MASS: f64 = 1.15;
/// Standard errors of the estimate that do not count. The usual 95 %.
const WITHIN: f64 = 2.0;

/// A moment of inertia, kg m^2.
#[derive(Debug, Clone, Copy)]
pub(in crate::study) struct Moment {
    pub(in crate::study) value: f64,
    pub(in crate::study) std: f64,
    /// by the flight
    pub(in crate::study) is_determined: bool,
}

/// A note on moments of inertia of a multirotor where the one about z is certainly smaller than one across.
pub(in crate::study) fn of_shape(across: [Moment; 2], about_z: Moment) -> Option<Note> {
    let of = |across: &Moment| (across.value, across.std);
    let (largest, std) = across.iter().map(of).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_smaller = largest - about_z.value > WITHIN * std.hypot(about_z.std);
    let stated = if about_z.is_determined {
        ""
    } else {
        " (which the flight does not determine, and the model keeps near the stated one)"
    };
    let text = || {
        format!(
            "izz{stated} is {:.2} times the larger one of ixx and iyy. Rotors and arms of a multirotor lie in a plane, so that izz is larger than \
             both, up to their sum, unless a heavy load is fixed far below or above them. Without such a load one of these moments is wrong \
             by more than its error: do not build on them without a measurement on the bench",
            about_z.value / largest
        )
    };
    is_smaller.then(|| Note::warning(About::Estimate, text()))
}

/// What speaks against an answer, clause by clause: what the vehicle file states and is hardly meant, rotors other
/// than the autopilot's, and results that are far from the file's.
pub(super) fn doubts<'a>(
    vehicle: &Vehicle,
    flights: impl IntoIterator<Item = &'a Quality>,
    contradictions: &[Contradiction],
) -> Vec<String> {
    let mut doubts: Vec<String> = contradicts_file(contradictions).into_iter().collect();
    let other_rotors = |quality: &Quality| {
        quality.notes.iter().any(|note| note.is_warning() && note.about == About::Vehicle)
    };
    let flights: Vec<&Quality> = flights.into_iter().collect();
    if flights.iter().copied().any(other_rotors) {
        doubts.push(OTHER_ROTORS.to_owned());
    }
    if flights.iter().flat_map(|quality| &quality.notes).any(|note| note.about == About::Contradiction) {
        doubts.push(CONTRADICTION.to_owned());
    }
    let odd = vehicle.implausible();
    // questions are for the warnings
    doubts.extend(odd.iter().map(|odd| format!("implausible vehicle data, {}", odd.trim_end_matches('?'))));
    doubts
}

/// A note on a mass by the stated thrust, kg with its standard error, that differs from the stated one by more than files do.
pub(in crate::study) fn of_mass((kg, std_kg): (f64, f64), stated_kg: f64) -> Option<Note> {
    let factor = kg / stated_kg;
    let apart = factor.ln().abs() - WITHIN * std_kg / kg.abs();
    let text = || {
        format!(
            "the mass is {factor:.2} times what the vehicle file states, if the rotors give the thrust that it states. If the mass was \
             weighed, the thrust is {:.2} times what is stated, and so is each force and moment of inertia of this answer: set anchor = \
             \"mass\" below [identify] in the vehicle file",
            factor.recip()
        )
    };
    (apart >= ORDINARY_MASS.ln()).then(|| Note::warning(About::Estimate, text()))
}

/// A note on a factor of the stated thrust (-), with its standard error, of a weighed vehicle that differs from one by more than files do.
pub(in crate::study) fn of_thrust(name: &str, (factor, std): (f64, f64)) -> Option<Note> {
    let apart = factor.ln().abs() - WITHIN * std / factor.abs();
    let text = || {
        format!(
            "{name} is {factor:.2} times what the vehicle file states, if the vehicle flew with the stated mass. If it carried a load, or was not \
             weighed, the mass is {:.2} times the stated one, and so is each force and moment of inertia of this answer",
            factor.recip()
        )
    };
    (apart >= ORDINARY_MASS.ln()).then(|| Note::warning(About::Estimate, text()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_is_slimmer_than_any_multirotor_is_told_beyond_its_errors() {
        let moment = |value, std| Moment { value, std, is_determined: true };
        let across = [moment(2.1e-2, 1e-3), moment(2.6e-2, 1e-3)];
        let slim = moment(1.7e-2, 1e-3);
        let told = of_shape(across, slim).map(|note| note.text);
        assert!(told.is_some_and(|text| text.starts_with("izz is 0.65 times")));
        let stated = of_shape(across, Moment { is_determined: false, ..slim }).map(|note| note.text);
        assert!(stated.is_some_and(|text| text.starts_with("izz (which the flight does not determine")));
        // within the errors, by a guess, and of a flat body: nothing
        assert!(of_shape(across, moment(2.4e-2, 1e-3)).is_none());
        assert!(of_shape(across, moment(1.7e-2, 0.3 * 1.7e-2)).is_none());
        assert!(of_shape(across, moment(4.0e-2, 1e-3)).is_none());
    }
}
