//! The flights of a vehicle as charts.

use crate::change::interval_95;
use crate::report::chart::{Band, Line, Panel, Stroke, inline};
use crate::study::{CompareStudy, Track};
use maud::Markup;

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
        charts.push(chart(study, ("Thrust for a command, over the mean rotor's", "1"), &lines));
    }
    charts.push(balance(study));
    let is_shown = |track: &&Track| track.values.iter().flatten().count() > 1;
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

/// The chart of one parameter.
fn of_track(study: &CompareStudy, track: &Track) -> Markup {
    let told = |value: &Option<(f64, f64)>| value.filter(|estimate| track.is_determined(*estimate));
    let line = Along { label: track.name.clone(), values: track.values.iter().map(told).collect() };
    chart(study, (&track.name, track.unit), &[line])
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
    // from behind the last flight that shows what was before to ahead of the first that shows what is since
    let mut spans: Vec<[f64; 2]> = Vec::new();
    for step in &study.history {
        for change in &step.change.changes {
            let (last, first) = study.dated(step, change.what);
            let span = [last.map_or(first, |last| last + 1), first].map(|place| place as f64 + 0.5);
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
