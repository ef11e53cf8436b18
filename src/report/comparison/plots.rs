//! The flights of a vehicle as charts.

use crate::change::interval_95;
use crate::report::chart::{Band, Line, Panel, Stroke, inline};
use crate::study::{CompareStudy, Track};
use maud::Markup;

/// What bands and shades are.
pub(in crate::report) const CAPTION: &str =
    "Bands: 95 % intervals. Shaded: the vehicle changed between these flights.";
/// Free on both sides of a shade, in distances of two flights: that of a flight alone parts those of its two steps.
const FREE: f64 = 0.15;

/// One line along the flights, with its intervals.
struct Along {
    label: String,
    values: Vec<Option<(f64, f64)>>,
}

/// The charts of a vehicle along its flights: what its rotors give, its balance, and each parameter that two flights have.
pub(in crate::report) fn plots(study: &CompareStudy) -> Vec<Markup> {
    let mut charts = Vec::new();
    if !study.rotors.is_empty() {
        let of = |(place, track): (usize, &Vec<(f64, f64)>)| Along {
            label: study.vehicle.motor_words(place),
            values: track.iter().map(|value| Some(*value)).collect(),
        };
        let lines: Vec<Along> = study.rotors.iter().enumerate().map(of).collect();
        charts.push(chart(
            study,
            ("Thrust for a command, over the mean rotor's", "share of the mean rotor's"),
            &lines,
        ));
    }
    charts.push(balance(study));
    let is_shown = |track: &&Track| told(track).flatten().count() > 1;
    charts.extend(study.tracks.iter().filter(is_shown).map(|track| of_track(study, track)));
    charts
}

/// Where the thrust acts against the centre of mass.
fn balance(study: &CompareStudy) -> Markup {
    let (arm, unit) = study.arm_m().map_or((1.0, "arms"), |arm_m| (arm_m, "m"));
    let along = |axis: usize, label: &str| Along {
        label: label.to_owned(),
        values: (0..study.flights.len())
            .map(|place| {
                let (lean, std) = study.balance.lean(place, axis);
                Some((arm * lean, arm * std))
            })
            .collect(),
    };
    chart(
        study,
        ("Where the thrust acts from the centre of mass", unit),
        &[along(0, "along x"), along(1, "along y")],
    )
}

/// What each flight determines of a parameter.
fn told(track: &Track) -> impl Iterator<Item = Option<(f64, f64)>> {
    track.values.iter().map(|value| value.filter(|estimate| track.is_determined(*estimate)))
}

/// The chart of one parameter.
fn of_track(study: &CompareStudy, track: &Track) -> Markup {
    let line = Along { label: track.name.clone(), values: told(track).collect() };
    chart(study, (&track.name, axis_words(track.unit)), &[line])
}

/// A unit beside an axis: a number without one is said to be that.
fn axis_words(unit: &str) -> &str {
    if unit == "-" { "number without unit" } else { unit }
}

fn chart(study: &CompareStudy, (title, unit): (&str, &str), lines: &[Along]) -> Markup {
    let (mut drawn, mut bands) = (Vec::new(), Vec::new());
    for (colour, along) in lines.iter().enumerate() {
        let known: Vec<(f64, (f64, f64))> = (1_u32..)
            .zip(&along.values)
            .filter_map(|(flight, value)| Some((f64::from(flight), (*value)?)))
            .collect();
        let x: Vec<f64> = known.iter().map(|(x, ..)| *x).collect();
        let (low, high) =
            known.iter().map(|(_, value)| interval_95(*value)).map(|[low, high]| (low, high)).unzip();
        bands.push(Band { x: x.clone(), low, high, colour });
        drawn.push(Line {
            label: along.label.clone(),
            x,
            y: known.iter().map(|(_, (value, _))| *value).collect(),
            stroke: Stroke::Solid,
            colour: Some(colour),
        });
    }
    let mut spans: Vec<[f64; 2]> = Vec::new();
    for step in &study.history {
        for change in &step.change.changes {
            let span = shade(study.dated(step, change.what));
            if !spans.contains(&span) {
                spans.push(span);
            }
        }
    }
    inline(&Panel {
        title: title.to_owned(),
        x_label: "flight".to_owned(),
        y_label: unit.to_owned(),
        lines: drawn,
        bands,
        spans,
        spans_label: "changed".to_owned(),
        cursor: None,
        log: (false, false),
    })
}

/// What is shaded of a step: between the last flight that shows what was before and the first one that shows what is since, from 1.
fn shade((last, first): (Option<usize>, usize)) -> [f64; 2] {
    let number = |place: usize| place as f64 + 1.0;
    [last.map_or(number(first) - 1.0, number) + FREE, number(first) - FREE]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_shaded_between_the_flights_that_show_it() {
        let is = |dated, [from, to]: [f64; 2]| {
            let shaded = shade(dated);
            (shaded[0] - from).abs() < 1e-9 && (shaded[1] - to).abs() < 1e-9
        };
        // flights 2 and 3 are neighbours: what is between them is seen
        assert!(is((Some(1), 2), [2.15, 2.85]));
        // flights 3 and 4 do not tell
        assert!(is((Some(1), 4), [2.15, 4.85]));
        assert!(is((None, 2), [2.15, 2.85]));
        // a flight alone has a shade on each side
        assert!(shade((Some(1), 2))[1] < shade((Some(2), 3))[0]);
    }

    #[test]
    fn no_axis_has_a_sign_for_its_unit_that_says_nothing() {
        assert_eq!(axis_words("kg m^2"), "kg m^2");
        assert_eq!(axis_words("-"), "number without unit");
    }
}
