//! The vehicle from above, with what changed of it.

use crate::change::What;
use crate::report::number::{significant, with_error};
use crate::report::vehicle_drawing::{MEANT, Mark, RIVAL, vehicle_drawing};
use crate::study::{Change, Changed, CompareStudy, Compared};
use crate::text::capital;
use maud::Markup;

/// Most lines below a motor: for more there is no room beside the others.
const MOST_LINES: usize = 3;

/// The vehicle from above, forward upwards: the rotor that changed is filled, what it may be instead is ringed.
pub(super) fn drawing(study: &CompareStudy) -> Markup {
    let label = "the vehicle from above";
    vehicle_drawing(&study.vehicle.rotors, label, |place| mark(study, place), of_centre(study))
}

/// All that changed: between the groups, or along the flights.
fn changes(study: &CompareStudy) -> impl Iterator<Item = &Change> {
    let along = study.history.iter().filter(|_| study.compared.is_none()).map(|step| &step.change);
    study.compared.iter().chain(along).flat_map(|compared| &compared.changes)
}

/// What the drawing shows.
pub(super) fn caption(study: &CompareStudy) -> String {
    let places = 0..study.vehicle.rotors.len();
    let marks: Vec<Mark> = places.clone().filter_map(|place| mark(study, place)).collect();
    let mut words = vec!["From above, forward upwards.".to_owned()];
    if marks.iter().any(|mark| mark.is_filled) {
        let filled = "Filled: the rotor that changed, with its thrust for the same command over that before.";
        words.push(filled.to_owned());
    }
    if study.compared.is_none() {
        words
            .extend(places.filter_map(|place| along(&study.vehicle.motor_words(place), &left(study, place))));
    }
    if marks.iter().any(|mark| !mark.is_filled) {
        words.push("Ringed: a rotor that may be the cause instead.".to_owned());
    }
    if marks.is_empty() && !of_centre(study) {
        words.push("No rotor is known to have changed.".to_owned());
    }
    words.join(" ")
}

fn mark(study: &CompareStudy, place: usize) -> Option<Mark> {
    if changes(study).any(|change| change.what == Changed::Rotor(place)) {
        Some(Mark { colour: MEANT, is_filled: true, words: labels(&left(study, place)) })
    } else {
        let is_rival = changes(study).any(|change| change.rivals.contains(&What::Rotor(place)));
        is_rival.then_some(Mark { colour: RIVAL, is_filled: false, words: Vec::new() })
    }
}

fn of_centre(study: &CompareStudy) -> bool {
    changes(study).any(|change| matches!(change.what, Changed::CentreOfMass(_)))
}

/// What a step leaves of a rotor's thrust.
struct Left {
    /// number of the first flight after the step, from 1; 1 where two groups are compared
    from: usize,
    /// with its standard error
    percent: (f64, f64),
}

/// What each step leaves of a rotor's thrust, in their order.
fn left(study: &CompareStudy, place: usize) -> Vec<Left> {
    let rotor = Changed::Rotor(place);
    let percent = |compared: &Compared| {
        let change = compared.changes.iter().find(|change| change.what == rotor)?;
        let (after, std) = change.moved?.after;
        Some((100.0 * after, 100.0 * std))
    };
    if let Some(compared) = &study.compared {
        return percent(compared).map(|percent| Left { from: 1, percent }).into_iter().collect();
    }
    let each = study.history.iter().filter_map(|step| {
        Some(Left { from: study.dated(step, rotor).1 + 1, percent: percent(&step.change)? })
    });
    each.collect()
}

/// Lines below a motor: of one step with its error, of several each in short.
fn labels(steps: &[Left]) -> Vec<String> {
    if let [Left { percent: (value, std), .. }] = steps {
        return vec![format!("{} %", with_error(*value, *std))];
    }
    let shown = if steps.len() > MOST_LINES { MOST_LINES - 1 } else { MOST_LINES };
    let line = |step: &Left| format!("from {}: {} %", step.from, significant(step.percent.0, 3));
    let more = steps.len().saturating_sub(shown);
    let more = (more > 0).then(|| format!("and {more} more"));
    steps.iter().take(shown).map(line).chain(more).collect()
}

/// A sentence on all steps of a motor along the flights; `None`: it has none.
fn along(motor: &str, steps: &[Left]) -> Option<String> {
    let step = |of: &Left| format!("{} % from flight {} on", with_error(of.percent.0, of.percent.1), of.from);
    let steps: Vec<String> = steps.iter().map(step).collect();
    (!steps.is_empty()).then(|| format!("{}: {}.", capital(motor), steps.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_step_of_a_rotor_is_told() {
        let step = |from, percent| Left { from, percent: (percent, 0.06) };
        assert_eq!(labels(&[step(1, 94.93)]), ["94.93 +- 0.06 %"]);
        let two = [step(6, 94.93), step(11, 94.64)];
        assert_eq!(labels(&two), ["from 6: 94.9 %", "from 11: 94.6 %"]);
        assert_eq!(
            along("motor 3 (front left)", &two).unwrap_or_default(),
            "Motor 3 (front left): 94.93 +- 0.06 % from flight 6 on, 94.64 +- 0.06 % from flight 11 on."
        );
        assert_eq!(along("motor 1 (front)", &[]), None);
        let many: Vec<Left> = (2..7).map(|from| step(from, 90.0)).collect();
        assert_eq!(labels(&many), ["from 2: 90.0 %", "from 3: 90.0 %", "and 3 more"]);
    }
}
