//! The plots of the report.

use super::story::Story;
use crate::diagnose::locate::Follow;
use crate::diagnose::{AXES, CHANNEL_NAMES, Fitted, LackOfFit, Trace, Verdict, lack_of_fit};
use crate::report::chart::{Band, Bars, Line, Panel, Strip, Stroke};
use std::ops::Range;

/// Points of a line at most: a chart is some 440 dots wide.
const POINTS: usize = 900;
/// Colours and words of the model before and after.
const BEFORE: usize = 1;
const AFTER: usize = 2;
const FOUND: &str = "model found";
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
    fn worst_axis(&self) -> usize {
        self.located.worst_axis().unwrap_or(0)
    }

    /// The words for the model after.
    fn model_after(&self) -> &'static str {
        if self.empirical.is_some() { "with the empirical force" } else { FOUND }
    }

    /// What is left of an axis over all flights, before; an empirical force is fitted to what the sensors' own part is out
    /// of.
    fn left_before(&self, axis: usize) -> Vec<f64> {
        let before = &self.explanation.search.before;
        if self.empirical.is_some() {
            before.weighted.left_of(axis)
        } else {
            before.rows.residual[axis].clone()
        }
    }

    /// The same after: of the model found, less the empirical force where there is one.
    fn left_after(&self, traces: &[Trace], axis: usize) -> Vec<f64> {
        let search = &self.explanation.search;
        match &self.empirical {
            None => search.after.rows.residual[axis].clone(),
            // of what it was fitted to: without a name that is the rigid body
            Some(term) if self.verdict() == Verdict::Unexplained => {
                term.left_of(&search.before, traces, axis)
            }
            Some(term) => term.left_of(&search.after, traces, axis),
        }
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
        let left = (self.left_before(axis), self.left_after(traces, axis));
        traces
            .iter()
            .zip(ranges(traces))
            .enumerate()
            .filter_map(|(flight, (trace, rows))| {
                let recorded = recorded(trace, axis)?;
                let simulated = |fitted: &Fitted, left: &[f64]| -> Vec<f64> {
                    recorded.iter().zip(left).map(|(r, e)| r - e / scale(fitted)).collect()
                };
                let time_s = &before.rows.time_s[rows.clone()];
                let line = |label: &str, y: Vec<f64>, colour| line(label, time_s, &y, colour);
                let located = self.explanation.located_before.as_ref();
                let spans = located.map_or_else(Vec::new, |located| {
                    let here = located.spans.iter().filter(|s| s.channel == axis && s.flight == flight);
                    here.map(|span| [span.from_s, span.to_s]).collect()
                });
                Some(Panel {
                    title: format!(
                        "{quantity} along body {}, flight {}",
                        ["x", "y", "z"][axis % 3],
                        flight + 1
                    ),
                    x_label: "time (s)".to_owned(),
                    y_label: unit.to_owned(),
                    lines: vec![
                        line("rigid body", simulated(before, &left.0[rows.clone()]), BEFORE),
                        line(self.model_after(), simulated(after, &left.1[rows.clone()]), AFTER),
                        line("recorded", recorded.clone(), 0),
                    ],
                    spans,
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
        let before = &self.left_before(axis)[rows.clone()];
        let after = &self.left_after(traces, axis)[rows];
        Some(Panel {
            title: format!("what is left of {}, recorded less simulated", axis_name(axis)),
            x_label: "time (s)".to_owned(),
            y_label: if axis < 3 { "N" } else { "N m" }.to_owned(),
            lines: vec![
                line("rigid body", time_s, before, BEFORE),
                line(self.model_after(), time_s, after, AFTER),
            ],
            ..Panel::default()
        })
    }

    /// The residual against the state that it follows most, before and after, with the bands of the bins.
    pub(super) fn followed(&self) -> Option<Panel> {
        let before = self.explanation.located_before.as_ref()?;
        let most = before.follows.first()?;
        let same = |follow: &&Follow| follow.channel == most.channel && follow.state == most.state;
        let after = self.explanation.located_after.as_ref().and_then(|after| after.follows.iter().find(same));
        let line = |label: &str, follow: &Follow, colour| Line {
            label: label.to_owned(),
            x: follow.bins.iter().map(|bin| bin.center).collect(),
            y: follow.bins.iter().map(|bin| bin.mean).collect(),
            colour: Some(colour),
            ..Line::default()
        };
        let band = |follow: &Follow, colour| Band {
            x: follow.bins.iter().map(|bin| bin.center).collect(),
            low: follow.bins.iter().map(|bin| bin.low).collect(),
            high: follow.bins.iter().map(|bin| bin.high).collect(),
            colour,
        };
        let state = most.state.name().replace('_', " ");
        let mut panel = Panel {
            title: format!("what is left of {} against {state}", axis_name(most.channel)),
            x_label: format!("{state} ({})", most.state.unit()),
            y_label: if CHANNEL_NAMES[most.channel].contains("force") { "N" } else { "N m" }.to_owned(),
            lines: vec![line("rigid body", most, BEFORE)],
            bands: vec![band(most, BEFORE)],
            ..Panel::default()
        };
        // the empirical force is a curve through these bins
        if let Some(after) = after.filter(|_| self.empirical.is_none()) {
            panel.lines.push(line(FOUND, after, AFTER));
            panel.bands.push(band(after, AFTER));
        }
        Some(panel)
    }

    /// Residual of each axis before and after, over what is left in the end.
    pub(super) fn axes_chart(&self, traces: &[Trace]) -> Bars {
        let search = &self.explanation.search;
        // what the empirical force leaves of what the model left
        let rms = |left: &[f64]| left.iter().map(|left| left * left).sum::<f64>().sqrt();
        let share = |axis: usize| {
            if self.empirical.is_none() {
                return 1.0;
            }
            let share = rms(&self.left_after(traces, axis)) / rms(&search.after.weighted.left_of(axis));
            if share.is_finite() { share } else { 1.0 }
        };
        let after = |axis: usize| search.after.weighted.sigma[axis] * share(axis);
        let ratio = |sigma: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..AXES).map(|axis| sigma(axis) / after(axis)).collect()
        };
        Bars {
            title: "residual of each axis, in units of what is left after".to_owned(),
            unit: String::new(),
            names: (0..AXES).map(axis_name).collect(),
            series: vec![
                ("rigid body".to_owned(), BEFORE, ratio(&|axis| search.before.weighted.sigma[axis])),
                (self.model_after().to_owned(), AFTER, ratio(&after)),
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
        let before: [Vec<f64>; AXES] = std::array::from_fn(|axis| self.left_before(axis));
        let after: [Vec<f64>; AXES] = std::array::from_fn(|axis| self.left_after(traces, axis));
        for (label, left) in [("before", before), ("after", after)] {
            for (axis, residual) in left.iter().enumerate() {
                let noise = search.after.weighted.sigma[axis].max(f64::MIN_POSITIVE);
                let cells = centers.iter().map(|center| {
                    let inside = time_s
                        .iter()
                        .zip(&residual[rows.clone()])
                        .filter(|(t, _)| (*t - center).abs() < 0.5 * CELL_S);
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
            lines: vec![line("rigid body", &before, BEFORE, -shift), line(FOUND, after, AFTER, shift)],
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

/// The measured specific force or angular acceleration behind the weak form, one value a row.
fn recorded(trace: &Trace, axis: usize) -> Option<Vec<f64>> {
    if axis < 3 {
        return trace.weak_specific_force().first().map(|force| force[axis].clone());
    }
    let rates: Vec<f64> = trace.states.iter().map(|state| state.rates_rad_s[axis - 3]).collect();
    Some(trace.weak(1, &rates))
}
