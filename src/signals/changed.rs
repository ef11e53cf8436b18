//! Parameters that changed while the vehicle flew.

use crate::autopilot::Autopilot;
use crate::note::{About, Note};
use crate::recording::ParameterChange;

/// Changes that are told one by one.
const TOLD: usize = 8;

/// Notes on the changes in the air (spans in s) that matter: of the way from command to thrust and of the vehicle's build a
/// warning, of the controllers' gains a remark.
#[must_use]
pub fn changes_in_the_air(
    autopilot: Autopilot,
    changes: &[ParameterChange],
    airborne_s: &[(f64, f64)],
) -> Vec<Note> {
    let Some(outputs) = autopilot.stack().map(|stack| &stack.outputs) else { return Vec::new() };
    let in_the_air = |change: &&ParameterChange| {
        airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&change.time_s))
    };
    let flown = || changes.iter().filter(in_the_air);
    let matters = |change: &&ParameterChange| {
        [change.before, change.after].iter().any(|value| outputs.is_relevant(&change.name, *value))
    };
    let gains = |change: &&ParameterChange| !matters(change) && outputs.is_gain(&change.name);
    let told = |change: &ParameterChange| {
        let ParameterChange { time_s, name, before, after } = change;
        format!("{name} changed from {} to {} at {time_s:.1} s, in the air", short(*before), short(*after))
    };
    let mut notes: Vec<Note> = flown()
        .filter(matters)
        .take(TOLD)
        .map(|change| {
            let text = format!("{}: the last value is taken for the whole flight", told(change));
            Note::warning(About::Actuators, text)
        })
        .collect();
    notes.extend(flown().filter(gains).take(TOLD).map(|change| Note::remark(About::Actuators, told(change))));
    let further = flown().filter(|change| matters(change) || gains(change)).count() - notes.len();
    if further > 0 {
        let text = format!("{further} more changes of parameters in the air");
        notes.push(Note::remark(About::Actuators, text));
    }
    notes
}

/// As many digits as single precision has.
fn short(value: f64) -> String {
    let digits = format!("{value:.6e}").parse::<f64>().unwrap_or(value);
    digits.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(time_s: f64, name: &str, before: f64, after: f64) -> ParameterChange {
        ParameterChange { time_s, name: name.to_owned(), before, after }
    }

    #[test]
    fn what_matters_and_changed_in_the_air_is_told_with_both_values() {
        let changes = [
            change(1.0, "MOT_THST_EXPO", 0.5, 0.6),
            change(34.25, "MOT_THST_EXPO", f64::from(0.65_f32), 0.5),
            change(35.0, "ATC_RAT_RLL_P", 0.1, 0.2),
            change(36.0, "STAT_RUNTIME", 1.0, 2.0),
            change(37.0, "SERVO1_FUNCTION", 33.0, 34.0),
        ];
        let notes = changes_in_the_air(Autopilot::ArduPilot, &changes, &[(10.0, 60.0)]);
        let texts: Vec<&str> = notes.iter().map(|note| note.text.as_str()).collect();
        assert_eq!(texts.len(), 3, "{texts:?}");
        assert!(
            texts[0].starts_with("MOT_THST_EXPO changed from 0.65 to 0.5 at 34.2 s, in the air"),
            "{texts:?}"
        );
        assert!(texts[1].starts_with("SERVO1_FUNCTION changed from 33 to 34"), "{texts:?}");
        assert!(texts[2].starts_with("ATC_RAT_RLL_P") && !notes[2].is_warning(), "{texts:?}");
        assert_eq!(changes_in_the_air(Autopilot::ArduPilot, &changes, &[]), []);
    }

    #[test]
    fn very_many_changes_have_an_end() {
        let changes: Vec<_> =
            (0..50).map(|n| change(20.0, "MC_ROLLRATE_P", f64::from(n), f64::from(n + 1))).collect();
        let notes = changes_in_the_air(Autopilot::Px4, &changes, &[(10.0, 60.0)]);
        assert_eq!(notes.len(), TOLD + 1);
        assert_eq!(notes[TOLD].text, "42 more changes of parameters in the air");
    }
}
