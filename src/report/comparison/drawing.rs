//! The vehicle from above, with what changed of it.

use crate::change::What;
use crate::report::number::with_error;
use crate::report::vehicle_drawing::{MEANT, Mark, RIVAL, vehicle_drawing};
use crate::study::{Changed, CompareStudy};
use maud::Markup;

/// The vehicle from above, forward upwards: the rotor that changed is filled, what it may be instead is ringed.
pub(super) fn drawing(study: &CompareStudy) -> Markup {
    let label = "the vehicle from above";
    vehicle_drawing(&study.vehicle.rotors, label, |place| mark(study, place), of_centre(study))
}

/// All that changed: between the groups, or along the flights.
fn changes(study: &CompareStudy) -> impl Iterator<Item = &crate::study::Change> {
    let along = study.history.iter().filter(|_| study.compared.is_none()).map(|step| &step.change);
    study.compared.iter().chain(along).flat_map(|compared| &compared.changes)
}

/// What the drawing shows.
pub(super) fn caption(study: &CompareStudy) -> String {
    let marks: Vec<Mark> = (0..study.vehicle.rotors.len()).filter_map(|place| mark(study, place)).collect();
    let mut words = vec!["From above, forward upwards."];
    if marks.iter().any(|mark| mark.is_filled) {
        words.push("Filled: the rotor that changed, with its thrust for the same command over that before.");
    }
    if marks.iter().any(|mark| !mark.is_filled) {
        words.push("Ringed: a rotor that may be the cause instead.");
    }
    if marks.is_empty() && !of_centre(study) {
        words.push("No rotor is known to have changed.");
    }
    words.join(" ")
}

fn mark(study: &CompareStudy, place: usize) -> Option<Mark> {
    if changes(study).any(|change| change.what == Changed::Rotor(place)) {
        Some(Mark { colour: MEANT, is_filled: true, words: factor(study, place) })
    } else {
        let is_rival = changes(study).any(|change| change.rivals.contains(&What::Rotor(place)));
        is_rival.then_some(Mark { colour: RIVAL, is_filled: false, words: None })
    }
}

fn of_centre(study: &CompareStudy) -> bool {
    changes(study).any(|change| matches!(change.what, Changed::CentreOfMass(_)))
}

/// What is left of a rotor's thrust, percent.
fn factor(study: &CompareStudy, place: usize) -> Option<String> {
    let change = changes(study).find(|change| change.what == Changed::Rotor(place))?;
    let (after, std) = change.moved?.after;
    Some(format!("{} %", with_error(100.0 * after, 100.0 * std)))
}
