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

/// A note on moments of inertia of a multirotor, kg m^2 with their standard errors, where the one about z is certainly smaller than one
/// across.
pub(in crate::study) fn of_shape(across: [(f64, f64); 2], about_z: (f64, f64)) -> Option<Note> {
    let (largest, std) = across.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_smaller = largest - about_z.0 > WITHIN * std.hypot(about_z.1);
    let text = || {
        format!(
            "izz is {:.2} times the larger one of ixx and iyy. Rotors and arms of a multirotor lie in a plane, so that izz is larger than \
             both, up to their sum, unless a heavy load is fixed far below or above them. Without such a load one of these moments is wrong \
             by more than its error: do not build on them without a measurement on the bench",
            about_z.0 / largest
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_is_slimmer_than_any_multirotor_is_told_beyond_its_errors() {
        let across = [(2.1e-2, 1e-3), (2.6e-2, 1e-3)];
        let told = of_shape(across, (1.7e-2, 1e-3)).map(|note| note.text);
        assert!(told.is_some_and(|text| text.starts_with("izz is 0.65 times")));
        // within the errors, by a guess, and of a flat body: nothing
        assert!(of_shape(across, (2.4e-2, 1e-3)).is_none());
        assert!(of_shape(across, (1.7e-2, 0.3 * 1.7e-2)).is_none());
        assert!(of_shape(across, (4.0e-2, 1e-3)).is_none());
    }
}
