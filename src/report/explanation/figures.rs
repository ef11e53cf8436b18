//! The charts of the report.

use super::whereabouts::channel_in_words;
use crate::diagnose::locate::{Bin, Followed as State, Portrait};
use crate::diagnose::{CHANNEL_NAMES, Line as HarmonicLine, called};
use crate::report::chart::{Band, Bars, Line, POINTS, Panel, Path3, PathValue, Strip, Stroke};
use crate::report::number::significant;
use crate::study::{
    AxisResidual, ExplainStudy, FlownPath, Followed, Harmonics, Heat, LeftAlongTime, PathResidual,
    RecordedAndSimulated,
};
use crate::vehicle::{AXIS_NAMES, Vehicle};

/// Colours of the model before and after.
const BEFORE: usize = 1;
const AFTER: usize = 2;
/// The colour of the page's words, on light and dark.
const RECORDED: usize = 6;
const ALONE: &str = "rigid body";
const FOUND: &str = "model found";
/// Residual with the darkest colour, beyond and relative to the residual after.
const DARK: f64 = 4.0;
/// Distance between the lines before and after, as a share of the harmonics' distance.
const APART: f64 = 0.12;

/// The words for the model after.
pub(super) fn model_after(study: &ExplainStudy) -> &'static str {
    if study.empirical.is_some() { "with the empirical force" } else { FOUND }
}

/// The same in a picture of one axis: an empirical force changes no torque of a model that has names.
pub(super) fn model_after_along(study: &ExplainStudy, axis: usize) -> &'static str {
    if axis < 3 || study.effects.is_empty() { model_after(study) } else { FOUND }
}

/// The lines of the rigid body alone and of the model found: one where nothing was found, and both are the same.
fn models(before: Line, after: Line) -> Vec<Line> {
    if before.y == after.y {
        vec![Line { label: format!("{ALONE}, which is the {FOUND}"), ..before }]
    } else {
        vec![before, after]
    }
}

/// Displayed name of an axis.
fn spoken(axis: &str) -> String {
    axis.replace('_', " ")
}

fn unit(axis: usize) -> String {
    if axis < 3 { "N" } else { "N m" }.to_owned()
}

/// Recorded motion, and its prediction by the models from the recorded commands.
pub(super) fn recorded_and_simulated(of: &RecordedAndSimulated, after: &str) -> Panel {
    let (unit, quantity) =
        if of.axis < 3 { ("m/s^2", "specific force") } else { ("rad/s^2", "angular acceleration") };
    Panel {
        title: format!("{quantity} along body {}, flight {}", AXIS_NAMES[of.axis % 3], of.flight + 1),
        x_label: "time (s)".to_owned(),
        y_label: unit.to_owned(),
        lines: models(line(ALONE, &of.time_s, &of.before, BEFORE), line(after, &of.time_s, &of.after, AFTER))
            .into_iter()
            .chain([Line { stroke: Stroke::Dashed, ..line("recorded", &of.time_s, &of.recorded, RECORDED) }])
            .collect(),
        cursor: Some(of.flight),
        spans: of.spans_s.clone(),
        spans_label: "mismatch".to_owned(),
        ..Panel::default()
    }
}

/// What one effect does over the state on which it depends: recorded, and by the model found.
pub(super) fn portrait(of: &Portrait, vehicle: &Vehicle) -> Panel {
    let (axis, state) = (channel_in_words(CHANNEL_NAMES[of.channel]), state_in_words(of.state, vehicle));
    let is_late = matches!(of.state, State::TorqueRate(_));
    let xy = |bins: &[Bin]| bins.iter().map(|bin| (bin.center, bin.mean)).unzip();
    let (x, y): (Vec<f64>, Vec<f64>) = xy(&of.recorded);
    let (model_x, model_y): (Vec<f64>, Vec<f64>) = xy(&of.model);
    Panel {
        title: if is_late {
            format!("{}: {axis} beyond the needed", called(of.id))
        } else {
            format!("{}: {axis} over {state}", called(of.id))
        },
        x_label: format!("{state} ({})", of.state.unit()),
        y_label: unit(of.channel),
        lines: vec![
            Line {
                label: "this effect in the model".into(),
                x: model_x,
                y: model_y,
                colour: Some(AFTER),
                ..Line::default()
            },
            Line { label: "recorded".into(), x, y, stroke: Stroke::Dots, colour: Some(RECORDED) },
        ],
        bands: vec![Band {
            x: of.recorded.iter().map(|bin| bin.center).collect(),
            low: of.recorded.iter().map(|bin| bin.low).collect(),
            high: of.recorded.iter().map(|bin| bin.high).collect(),
            colour: RECORDED,
        }],
        ..Panel::default()
    }
}

fn state_in_words(state: State, vehicle: &Vehicle) -> String {
    match state {
        State::Altitude => "height".to_owned(),
        State::Airspeed(axis) => format!("airspeed along body {}", AXIS_NAMES[axis.min(2)]),
        State::Rate(axis) => format!("rate about body {}", AXIS_NAMES[axis.min(2)]),
        State::Rotor(place) => format!("thrust of {}", vehicle.motor_words(place)),
        State::TorqueRate(_) => "rate of change of the needed torque".to_owned(),
        State::YawCos => "cosine of the heading".to_owned(),
        State::YawSin => "sine of the heading".to_owned(),
        other => other.name().replace('_', " "),
    }
}

/// The flown path, coloured by the residual of all axes.
pub(super) fn path(of: &FlownPath, after: &str) -> Path3 {
    let value = |name: &str, of: &PathResidual| {
        let [low, high] = of.most;
        let even = if of.is_even() { "about the same along the whole path: " } else { "" };
        let [low, high] = [low, high].map(|end| significant(end, 2));
        let words = format!("{even}nine tenths of the path lie between {low} and {high}");
        PathValue::new((name, of.along.clone()), of.colours, words)
    };
    Path3 {
        title: "flown path, coloured by the residual of all axes".to_owned(),
        time_s: of.time_s.clone(),
        position_m: of.position_m.clone(),
        axes: ["north", "west", "up"].map(str::to_owned),
        values: vec![value(ALONE, &of.before), value(after, &of.after)],
        unit: "times the residual after".to_owned(),
        ..Path3::default()
    }
}

/// The residual of the same axis, before and after.
pub(super) fn left_along_time(of: &LeftAlongTime, after: &str) -> Panel {
    Panel {
        title: format!("residual of {}, recorded minus simulated", spoken(CHANNEL_NAMES[of.axis])),
        x_label: "time (s)".to_owned(),
        y_label: unit(of.axis),
        lines: models(line(ALONE, &of.time_s, &of.before, BEFORE), line(after, &of.time_s, &of.after, AFTER)),
        cursor: Some(0),
        ..Panel::default()
    }
}

/// The residual over the state on which it depends most, before and after, with the bands of the bins.
pub(super) fn followed(of: &Followed) -> Panel {
    let line = |label: &str, bins: &[Bin], colour| Line {
        label: label.to_owned(),
        x: bins.iter().map(|bin| bin.center).collect(),
        y: bins.iter().map(|bin| bin.mean).collect(),
        colour: Some(colour),
        ..Line::default()
    };
    let band = |bins: &[Bin], colour| Band {
        x: bins.iter().map(|bin| bin.center).collect(),
        low: bins.iter().map(|bin| bin.low).collect(),
        high: bins.iter().map(|bin| bin.high).collect(),
        colour,
    };
    let state = match of.state.strip_prefix("rotor_") {
        Some(number) => format!("thrust of motor {number}"),
        None => spoken(&of.state),
    };
    // where nothing was found, both are the same
    let means = |bins: &[Bin]| bins.iter().map(|bin| bin.mean).collect::<Vec<_>>();
    let after = of.after.as_deref().filter(|after| means(after) != means(&of.before));
    Panel {
        title: format!("residual of {} over {state}", spoken(of.axis)),
        x_label: format!("{state} ({})", of.state_unit),
        y_label: of.unit.to_owned(),
        lines: [(ALONE, Some(&*of.before), BEFORE), (FOUND, after, AFTER)]
            .into_iter()
            .filter_map(|(label, bins, colour)| Some(line(label, bins?, colour)))
            .collect(),
        bands: [(Some(&*of.before), BEFORE), (after, AFTER)]
            .into_iter()
            .filter_map(|(bins, colour)| Some(band(bins?, colour)))
            .collect(),
        ..Panel::default()
    }
}

/// Residual of each axis before and after, relative to the residual after.
pub(super) fn axes(of: &[AxisResidual], after: &str) -> Bars {
    Bars {
        title: "residual of each axis, relative to the residual after".to_owned(),
        unit: String::new(),
        names: of.iter().map(|of| spoken(of.axis)).collect(),
        series: vec![
            (ALONE.to_owned(), BEFORE, of.iter().map(|of| of.before).collect()),
            (after.to_owned(), AFTER, vec![1.0; of.len()]),
        ],
    }
}

/// Misfit of each axis over time, before and after.
pub(super) fn heat(of: &Heat) -> Strip {
    let named = |rows: &[Vec<f64>], when: &str| -> Vec<(String, Vec<f64>)> {
        let names = CHANNEL_NAMES.iter().map(|name| format!("{} {when}", spoken(name)));
        names.zip(rows.iter().cloned()).collect()
    };
    let mut rows = named(&of.before, "before");
    rows.extend(named(&of.after, "after"));
    Strip {
        title: "residual over time, relative to the residual after".to_owned(),
        x_label: "time (s)".to_owned(),
        x: of.time_s.clone(),
        rows,
        full: DARK,
    }
}

/// Power at the trajectory's harmonics divided by the power next to them, before and after.
pub(super) fn harmonics(of: &Harmonics) -> Panel {
    let line = |label: &str, lines: &[HarmonicLine], colour, shift: f64| Line {
        label: label.to_owned(),
        x: lines.iter().map(|line| line.frequency_hz + shift).collect(),
        y: lines.iter().map(|line| line.ratio).collect(),
        stroke: Stroke::Stems,
        colour: Some(colour),
    };
    let shift = APART / of.period_s;
    Panel {
        title: format!("{}: power at the harmonics divided by the power next to them", spoken(of.axis)),
        x_label: format!("frequency (Hz); the trajectory repeats every {:.1} s", of.period_s),
        y_label: "ratio".to_owned(),
        lines: vec![line(ALONE, &of.before, BEFORE, -shift), line(FOUND, &of.after, AFTER, shift)],
        log: (false, true),
        ..Panel::default()
    }
}

fn line(label: &str, time_s: &[f64], y: &[f64], colour: usize) -> Line {
    let every = time_s.len().div_ceil(POINTS).max(1);
    Line {
        label: label.to_owned(),
        x: time_s.iter().step_by(every).copied().collect(),
        y: y.iter().step_by(every).copied().collect(),
        colour: Some(colour),
        ..Line::default()
    }
}
