//! The plots of the report.

use super::follow::{Binned, variables};
use super::located::{rolling, spans};
use super::story::Story;
use crate::diagnose::{AXES, CHANNEL_NAMES, Fitted, LackOfFit, Trace, lack_of_fit};
use crate::report::chart::{Band, Bars, Line, Panel, Strip, Stroke};
use std::ops::Range;

/// Points of a line at most: a chart is some 440 dots wide.
const POINTS: usize = 900;
/// Dots of a scatter at most.
const DOTS: usize = 500;
/// s of a cell of the heat strip.
const CELL_S: f64 = 1.0;

/// Rows of each flight.
fn ranges(traces: &[Trace]) -> Vec<Range<usize>> {
    let mut from = 0;
    let mut out = Vec::new();
    for trace in traces {
        out.push(from..from + trace.rows());
        from += trace.rows();
    }
    out
}

/// Name of an axis for people.
fn axis_name(axis: usize) -> String {
    CHANNEL_NAMES[axis].replace('_', " ")
}

impl Story {
    /// The axis with the largest share of the misfit; where nothing is missing, the first.
    pub(super) fn worst_axis(&self) -> usize {
        let worst = self.located.axes.first().map(|axis| axis.axis);
        CHANNEL_NAMES.iter().position(|name| Some(*name) == worst).unwrap_or(0)
    }

    /// What the body did along the worst axis, and what the models make of the recorded commands: one panel
    /// a flight.
    pub(super) fn recorded_and_simulated(&self, traces: &[Trace]) -> Vec<Panel> {
        let axis = self.worst_axis();
        let search = &self.explanation.search;
        let (before, after) = (&search.before, &search.after);
        let (unit, quantity) =
            if axis < 3 { ("m/s^2", "specific force") } else { ("rad/s^2", "angular acceleration") };
        let scale = |fitted: &Fitted| {
            let body = &fitted.base.vehicle.body;
            if axis < 3 { body.mass_kg } else { body.inertia_kg_m2[(axis - 3, axis - 3)] }
        };
        traces
            .iter()
            .zip(ranges(traces))
            .enumerate()
            .filter_map(|(flight, (trace, rows))| {
                let recorded = recorded(trace, axis)?;
                let simulated = |fitted: &Fitted| -> Vec<f64> {
                    let residual = &fitted.rows.residual[axis][rows.clone()];
                    recorded.iter().zip(residual).map(|(r, e)| r - e / scale(fitted)).collect()
                };
                let time_s = &before.rows.time_s[rows.clone()];
                let line = |label: &str, y: Vec<f64>, colour| line(label, time_s, &y, colour);
                let noise = after.weighted.sigma[axis];
                let misfit = &before.rows.residual[axis][rows.clone()];
                Some(Panel {
                    title: format!(
                        "{quantity} along body {}, flight {}",
                        ["x", "y", "z"][axis % 3],
                        flight + 1
                    ),
                    x_label: "time (s)".to_owned(),
                    y_label: unit.to_owned(),
                    lines: vec![
                        line("rigid body", simulated(before), 1),
                        line("with what was found", simulated(after), 2),
                        line("recorded", recorded.clone(), 0),
                    ],
                    spans: spans(time_s, &rolling(misfit), 2.0 * noise),
                    spans_label: "mismatch".to_owned(),
                    ..Panel::default()
                })
            })
            .collect()
    }

    /// What is left along the same axis, before and after.
    pub(super) fn residual_along_time(&self, traces: &[Trace]) -> Option<Panel> {
        let axis = self.worst_axis();
        let rows = ranges(traces).first()?.clone();
        let search = &self.explanation.search;
        let time_s = &search.before.rows.time_s[rows.clone()];
        let of = |label: &str, fitted: &Fitted, colour| {
            line(label, time_s, &fitted.rows.residual[axis][rows.clone()], colour)
        };
        Some(Panel {
            title: format!("what is left of {}, recorded less simulated", axis_name(axis)),
            x_label: "time (s)".to_owned(),
            y_label: if axis < 3 { "N" } else { "N m" }.to_owned(),
            lines: vec![of("rigid body", &search.before, 1), of("with what was found", &search.after, 2)],
            ..Panel::default()
        })
    }

    /// The residual of the worst axis against the state that it follows most, and that state's label.
    pub(super) fn followed(&self, traces: &[Trace]) -> Option<Panel> {
        let axis = self.worst_axis();
        let search = &self.explanation.search;
        let residual = &search.before.rows.residual[axis];
        let (variable, before) = variables(traces, &search.before)
            .into_iter()
            .map(|variable| {
                let binned = variable.bin(residual);
                (variable, binned)
            })
            .max_by(|a, b| a.1.share.total_cmp(&b.1.share))?;
        let after = variable.bin(&search.after.rows.residual[axis]);
        if before.at.is_empty() {
            return None;
        }
        let every = residual.len().div_ceil(DOTS).max(1);
        let dots = Line {
            x: variable.values().iter().step_by(every).copied().collect(),
            y: residual.iter().step_by(every).copied().collect(),
            stroke: Stroke::Dots,
            colour: Some(6),
            ..Line::default()
        };
        let mean = |label: &str, binned: &Binned, colour| Line {
            label: label.to_owned(),
            x: binned.at.clone(),
            y: binned.mean.clone(),
            colour: Some(colour),
            ..Line::default()
        };
        Some(Panel {
            title: format!("what is left of {} against {}", axis_name(axis), variable.label),
            x_label: variable.label.to_owned(),
            y_label: if axis < 3 { "N" } else { "N m" }.to_owned(),
            lines: vec![dots, mean("rigid body", &before, 1), mean("with what was found", &after, 2)],
            bands: vec![band(&before, 1), band(&after, 2)],
            ..Panel::default()
        })
    }

    /// Residual of each axis before and after, over what is left in the end.
    pub(super) fn axes_chart(&self) -> Bars {
        let search = &self.explanation.search;
        let ratio = |fitted: &Fitted| -> Vec<f64> {
            (0..AXES).map(|axis| fitted.weighted.sigma[axis] / search.after.weighted.sigma[axis]).collect()
        };
        Bars {
            title: "residual of each axis, in units of what is left after".to_owned(),
            unit: String::new(),
            names: (0..AXES).map(axis_name).collect(),
            series: vec![
                ("rigid body".to_owned(), ratio(&search.before)),
                ("after".to_owned(), ratio(&search.after)),
            ],
        }
    }

    /// When each axis misfits, before and after; the first flight.
    pub(super) fn heat(&self, traces: &[Trace]) -> Option<Strip> {
        let rows = ranges(traces).first()?.clone();
        let search = &self.explanation.search;
        let time_s = &search.before.rows.time_s[rows.clone()];
        let (first, last) = (*time_s.first()?, *time_s.last()?);
        let centers: Vec<f64> = (0_u32..600)
            .map(|cell| first + (f64::from(cell) + 0.5) * CELL_S)
            .take_while(|center| *center < last)
            .collect();
        let mut lines = Vec::new();
        for (label, fitted) in [("before", &search.before), ("after", &search.after)] {
            for axis in 0..AXES {
                let residual = &fitted.rows.residual[axis][rows.clone()];
                let noise = search.after.weighted.sigma[axis].max(f64::MIN_POSITIVE);
                let cells = centers.iter().map(|center| {
                    let inside =
                        time_s.iter().zip(residual).filter(|(t, _)| (*t - center).abs() < 0.5 * CELL_S);
                    let (sum, count) =
                        inside.fold((0.0, 0.0), |(sum, count), (_, r)| (sum + r * r, count + 1.0));
                    if count > 0.0 { ((sum / count).sqrt() / noise - 1.0).max(0.0) } else { f64::NAN }
                });
                lines.push((format!("{} {label}", axis_name(axis)), cells.collect()));
            }
        }
        Some(Strip {
            title: "residual along time, in units of what is left after".to_owned(),
            x_label: "time (s)".to_owned(),
            x: centers,
            rows: lines,
            full: 4.0,
        })
    }

    /// Power at the trajectory's harmonics over that beside them, before and after, worst axis.
    pub(super) fn harmonics(&self, traces: &[Trace]) -> Option<Panel> {
        let axis = self.worst_axis();
        let after = self.explanation.lack_of_fit.as_ref()?;
        let rows = ranges(traces).first()?.clone();
        let search = &self.explanation.search;
        let time_s = &search.before.rows.time_s[rows.clone()];
        let residual = std::array::from_fn(|channel| &search.before.rows.residual[channel][rows.clone()]);
        let before = lack_of_fit(time_s, residual, after.period_s)?;
        let line = |label: &str, lack: &LackOfFit, colour, shift: f64| Line {
            label: label.to_owned(),
            x: lack.lines[axis].iter().map(|line| line.frequency_hz + shift).collect(),
            y: lack.lines[axis].iter().map(|line| line.ratio).collect(),
            stroke: Stroke::Stems,
            colour: Some(colour),
        };
        let shift = 0.12 / after.period_s;
        Some(Panel {
            title: format!("{}: power at the harmonics over that beside them", axis_name(axis)),
            x_label: format!("frequency (Hz); the trajectory repeats every {:.1} s", after.period_s),
            y_label: "ratio".to_owned(),
            lines: vec![line("rigid body", &before, 1, -shift), line("after", after, 2, shift)],
            log: (false, true),
            ..Panel::default()
        })
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

fn band(binned: &Binned, colour: usize) -> Band {
    let end = |sign: f64| binned.mean.iter().zip(&binned.two_sigma).map(|(m, s)| m + sign * s).collect();
    Band { x: binned.at.clone(), low: end(-1.0), high: end(1.0), colour }
}

/// The measured specific force or angular acceleration behind the weak form, one value a row.
fn recorded(trace: &Trace, axis: usize) -> Option<Vec<f64>> {
    if axis < 3 {
        return trace.weak_specific_force().first().map(|force| force[axis].clone());
    }
    let rates: Vec<f64> = trace.states.iter().map(|state| state.rates_rad_s[axis - 3]).collect();
    Some(trace.weak(1, &rates))
}
