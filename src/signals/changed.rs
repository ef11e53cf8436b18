//! Parameters that changed while the vehicle flew, and those whose value is not in the log.

use std::collections::{BTreeMap, BTreeSet};

use super::reported_state::ReportedState;
use crate::autopilot::{Autopilot, Outputs};
use crate::note::{About, Note};
use crate::recording::{ParameterChange, Recording};

/// Changes that are told one by one. Only the length of a message depends on it.
const TOLD: usize = 8;

/// Takes, of each parameter that changed and on which the way from command to thrust or the vehicle's build depends, the value
/// that stood longest in the air: one that was set after the flight says nothing of it. The motor at an output stays there,
/// whatever drives the output afterwards.
pub fn adopt_in_flight_parameters(recording: &mut Recording) {
    if recording.parameter_changes.is_empty() {
        return;
    }
    let airborne_s = said_airborne(recording);
    let settled = in_flight_parameters(recording.autopilot, &recording.parameter_changes, &airborne_s);
    recording.parameters.extend(settled);
}

/// Name and value of each such parameter; `airborne_s` are spans in s. One that never stood in them is left out.
#[must_use]
pub fn in_flight_parameters(
    autopilot: Autopilot,
    changes: &[ParameterChange],
    airborne_s: &[(f64, f64)],
) -> Vec<(String, f64)> {
    let Some(outputs) = autopilot.stack().map(|stack| &stack.outputs) else { return Vec::new() };
    let mut by_name: BTreeMap<&str, Vec<&ParameterChange>> = BTreeMap::new();
    // learned in flight and told after it: the last value is the best
    let settles = |change: &&ParameterChange| matters(outputs, change) && change.name != outputs.hover;
    for change in changes.iter().filter(settles) {
        by_name.entry(change.name.as_str()).or_default().push(change);
    }
    let longest = |(name, changes): (&str, Vec<&ParameterChange>)| {
        let is_output = outputs.output_of(name).is_some();
        let is_wired = |value: f64| is_output && outputs.is_motor(value);
        Some((name.to_owned(), longest_value(&changes, airborne_s, is_wired)?))
    };
    by_name.into_iter().filter_map(longest).collect()
}

/// Of one parameter's values the one that stood longest in these spans (s), of the preferred ones if there are any.
fn longest_value(
    changes: &[&ParameterChange],
    airborne_s: &[(f64, f64)],
    is_preferred: impl Fn(f64) -> bool,
) -> Option<f64> {
    let since = |index: usize| changes.get(index).map_or(f64::INFINITY, |change| change.time_s);
    let stood_s = |from_s: f64, to_s: f64| -> f64 {
        airborne_s.iter().map(|(start_s, end_s)| (end_s.min(to_s) - start_s.max(from_s)).max(0.0)).sum()
    };
    let mut values = vec![(changes.first()?.before, stood_s(f64::NEG_INFINITY, since(0)))];
    for (index, change) in changes.iter().enumerate() {
        let seconds = stood_s(change.time_s, since(index + 1));
        match values.iter_mut().find(|(value, _)| value.to_bits() == change.after.to_bits()) {
            Some((_, known)) => *known += seconds,
            None => values.push((change.after, seconds)),
        }
    }
    values
        .into_iter()
        .filter(|(_, seconds)| *seconds > 0.0)
        .max_by(|a, b| is_preferred(a.0).cmp(&is_preferred(b.0)).then(a.1.total_cmp(&b.1)))
        .map(|(value, _)| value)
}

/// When the vehicle was in the air by the autopilot's words, s; all the time where it says nothing of it.
fn said_airborne(recording: &Recording) -> Vec<(f64, f64)> {
    let said = ReportedState::of(recording);
    let Some(words) = said.words() else { return vec![(f64::NEG_INFINITY, f64::INFINITY)] };
    let pairs = words.time_s.windows(2).map(|pair| (pair[0], pair[1]));
    pairs.filter(|(from_s, _)| said.may_be_off_ground(*from_s)).collect()
}

/// A note on the parameters of the way from command to thrust, and of the vehicle's build, of which the log holds only the
/// default.
#[must_use]
pub fn resting_on_defaults(
    autopilot: Autopilot,
    defaulted: &BTreeSet<String>,
    parameters: &BTreeMap<String, f64>,
) -> Option<Note> {
    let outputs = &autopilot.stack()?.outputs;
    let known = defaulted.iter().filter_map(|name| Some((name, *parameters.get(name)?)));
    let told: Vec<String> = known
        .filter(|(name, value)| outputs.is_relevant(name, *value))
        .map(|(name, value)| format!("{name} = {}", short(value)))
        .collect();
    let text = format!(
        "the log holds no value of these parameters, and their defaults are used: {}",
        told.join(", ")
    );
    (!told.is_empty()).then(|| Note::remark(About::Actuators, text))
}

fn matters(outputs: &Outputs, change: &ParameterChange) -> bool {
    [change.before, change.after].iter().any(|value| outputs.is_relevant(&change.name, *value))
}

/// Notes on the changes in the air (spans in s) that matter: of the way from command to thrust and of the vehicle's build a
/// warning with the value that is taken, of the controllers' gains a remark.
#[must_use]
pub fn changes_in_the_air(
    autopilot: Autopilot,
    changes: &[ParameterChange],
    airborne_s: &[(f64, f64)],
    taken: &BTreeMap<String, f64>,
) -> Vec<Note> {
    let Some(outputs) = autopilot.stack().map(|stack| &stack.outputs) else { return Vec::new() };
    let in_the_air = |change: &&ParameterChange| {
        airborne_s.iter().any(|(from_s, to_s)| (*from_s..=*to_s).contains(&change.time_s))
    };
    let flown = || changes.iter().filter(in_the_air);
    let matters = |change: &&ParameterChange| matters(outputs, change);
    let gains = |change: &&ParameterChange| !matters(change) && outputs.is_gain(&change.name);
    let told = |change: &ParameterChange| {
        let ParameterChange { time_s, name, before, after } = change;
        format!("{name} changed from {} to {} at {time_s:.1} s, in the air", short(*before), short(*after))
    };
    let mut notes: Vec<Note> = flown()
        .filter(matters)
        .take(TOLD)
        .map(|change| {
            let value = taken.get(&change.name).copied().unwrap_or(change.after);
            let left = outputs.output_of(&change.name).filter(|_| !outputs.is_motor(change.after));
            let text = match left {
                Some(output) => format!(
                    "{}: from then on output {output} does not follow the mixer, and what it carries is taken for the motor's command",
                    told(change)
                ),
                None => format!("{}: {} is used for the whole flight", told(change), short(value)),
            };
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

/// Notes on the parameters of the way from command to thrust, and of the vehicle's build, that are others in later flights than in the
/// first: those that differ alike are told together, by their numbers.
#[must_use]
pub fn other_settings(flights: &[Recording]) -> Vec<Note> {
    let Some((first, others)) = flights.split_first() else { return Vec::new() };
    let mut alike: Vec<(String, Vec<usize>)> = Vec::new();
    for (index, other) in others.iter().enumerate() {
        let Some(differs) = differences(first, other) else { continue };
        match alike.iter_mut().find(|(same, _)| *same == differs) {
            Some((_, numbers)) => numbers.push(index + 2),
            None => alike.push((differs, vec![index + 2])),
        }
    }
    let note = |(differs, numbers): (String, Vec<usize>)| {
        let who = match numbers.as_slice() {
            [one] => format!("flight {one} was"),
            all => {
                format!("flights {} were", all.iter().map(usize::to_string).collect::<Vec<_>>().join(", "))
            }
        };
        let text =
            format!("{who} flown with other settings than flight 1: {differs}: is it the same vehicle?");
        Note::warning(About::Actuators, text)
    };
    alike.into_iter().map(note).collect()
}

/// What of these differs between two flights of one autopilot, with both values.
fn differences(one: &Recording, other: &Recording) -> Option<String> {
    let outputs = &one.autopilot.stack().filter(|_| one.autopilot == other.autopilot)?.outputs;
    let differs = |(name, value): &(&String, &f64)| {
        let there = other.parameters.get(*name)?;
        let apart = (*there - **value).abs() > SAME * value.abs().max(there.abs());
        // learned in flight
        let counts = outputs.is_relevant(name, **value) && name.as_str() != outputs.hover;
        (apart && counts).then(|| format!("{name} {} in place of {}", short(*there), short(**value)))
    };
    let all: Vec<String> = one.parameters.iter().filter_map(|pair| differs(&pair)).collect();
    let more = if all.len() > TOLD { format!(" and {} more", all.len() - TOLD) } else { String::new() };
    let told = all.iter().take(TOLD).cloned().collect::<Vec<_>>().join(", ");
    (!all.is_empty()).then(|| format!("{told}{more}"))
}

/// Values in single precision that differ by less, as a share, are the same.
const SAME: f64 = 1e-6;

/// As many digits as single precision has.
fn short(value: f64) -> String {
    let digits = format!("{value:.6e}").parse::<f64>().unwrap_or(value);
    digits.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Quantity, Stream, StreamKey};

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
            change(38.0, "SERVO2_FUNCTION", 34.0, 1.0),
        ];
        let airborne_s = [(10.0, 60.0)];
        let taken = in_flight_parameters(Autopilot::ArduPilot, &changes, &airborne_s).into_iter().collect();
        let notes = changes_in_the_air(Autopilot::ArduPilot, &changes, &airborne_s, &taken);
        let texts: Vec<&str> = notes.iter().map(|note| note.text.as_str()).collect();
        assert_eq!(texts.len(), 4, "{texts:?}");
        assert!(
            texts[0].starts_with("MOT_THST_EXPO changed from 0.65 to 0.5 at 34.2 s, in the air: 0.5 is used"),
            "{texts:?}"
        );
        assert!(texts[1].starts_with("SERVO1_FUNCTION changed from 33 to 34"), "{texts:?}");
        assert!(
            texts[2].contains("34 to 1 at 38.0 s, in the air: from then on output 2 does not follow"),
            "{texts:?}"
        );
        assert!(texts[3].starts_with("ATC_RAT_RLL_P") && !notes[3].is_warning(), "{texts:?}");
        assert_eq!(changes_in_the_air(Autopilot::ArduPilot, &changes, &[], &taken), []);
    }

    #[test]
    fn the_value_that_stood_longest_in_the_air_is_taken() {
        let changes = [
            change(5.0, "MOT_THST_EXPO", 0.4, 0.65),
            change(30.0, "MOT_THST_EXPO", 0.65, 0.5),
            change(35.0, "MOT_THST_EXPO", 0.5, 0.65),
            // on the ground again
            change(70.0, "MOT_THST_EXPO", 0.65, 0.1),
            change(70.0, "MOT_THST_HOVER", 0.2, 0.3),
            change(40.0, "SERVO1_FUNCTION", 33.0, 34.0),
            change(12.0, "SERVO2_FUNCTION", 34.0, 1.0),
            change(40.0, "ATC_RAT_RLL_P", 0.1, 0.2),
        ];
        let settled = in_flight_parameters(Autopilot::ArduPilot, &changes, &[(10.0, 32.0), (34.0, 60.0)]);
        let expected = [("MOT_THST_EXPO", 0.65), ("SERVO1_FUNCTION", 33.0), ("SERVO2_FUNCTION", 34.0)];
        assert_eq!(settled, expected.map(|(name, value)| (name.to_owned(), value)));
        assert_eq!(in_flight_parameters(Autopilot::ArduPilot, &changes, &[]), []);
        let key = StreamKey { quantity: Quantity::Armed, source: "EV", instance: 0 };
        let armed =
            Stream { time_s: vec![0.0, 10.0, 60.0, 80.0], width: 1, values: vec![0.0, 1.0, 0.0, 0.0] };
        let mut recording = Recording {
            autopilot: Autopilot::ArduPilot,
            parameters: [("MOT_THST_EXPO".to_owned(), 0.1), ("MOT_THST_HOVER".to_owned(), 0.3)].into(),
            parameter_changes: changes.to_vec(),
            streams: [(key, armed)].into(),
            ..Recording::default()
        };
        adopt_in_flight_parameters(&mut recording);
        let values = [recording.parameters["MOT_THST_EXPO"], recording.parameters["MOT_THST_HOVER"]];
        assert_eq!(values, [0.65, 0.3]);
    }

    #[test]
    fn a_result_that_rests_on_a_default_says_so() {
        let parameters: BTreeMap<String, f64> =
            [("MOT_THST_EXPO", 0.65), ("MOT_SPIN_MIN", 0.15), ("LOG_BITMASK", 1.0)]
                .map(|(name, value)| (name.to_owned(), value))
                .into();
        let defaulted = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let note = |names: &[&str]| resting_on_defaults(Autopilot::ArduPilot, &defaulted(names), &parameters);
        let text = note(&["MOT_SPIN_MIN", "LOG_BITMASK"]).unwrap().text;
        assert!(text.ends_with("their defaults are used: MOT_SPIN_MIN = 0.15"), "{text}");
        assert_eq!(note(&["LOG_BITMASK"]), None);
    }

    #[test]
    fn settings_that_differ_between_flights_are_told() {
        let flown = |values: &[(&str, f64)]| Recording {
            autopilot: Autopilot::Px4,
            parameters: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Recording::default()
        };
        let one = flown(&[("THR_MDL_FAC", 0.0), ("MPC_THR_HOVER", 0.5), ("CA_ROTOR_COUNT", 4.0)]);
        let other = flown(&[("THR_MDL_FAC", 0.3), ("MPC_THR_HOVER", 0.4), ("CA_ROTOR_COUNT", 4.0)]);
        let told = |flights: &[Recording]| {
            other_settings(flights).into_iter().map(|note| note.text).collect::<Vec<_>>()
        };
        let differs =
            "flown with other settings than flight 1: THR_MDL_FAC 0.3 in place of 0: is it the same vehicle?";
        assert_eq!(told(&[one.clone(), other.clone()]), [format!("flight 2 was {differs}")]);
        let four = [one.clone(), other.clone(), one.clone(), other];
        assert_eq!(told(&four), [format!("flights 2, 4 were {differs}")]);
        assert!(told(&[one.clone(), one]).is_empty());
    }

    #[test]
    fn very_many_changes_have_an_end() {
        let changes: Vec<_> =
            (0..50).map(|n| change(20.0, "MC_ROLLRATE_P", f64::from(n), f64::from(n + 1))).collect();
        let notes = changes_in_the_air(Autopilot::Px4, &changes, &[(10.0, 60.0)], &BTreeMap::new());
        assert_eq!(notes.len(), TOLD + 1);
        assert_eq!(notes[TOLD].text, "42 more changes of parameters in the air");
    }
}
