//! What the report draws, as numbers: recorded and simulated, what is left of it, and where.

use super::result::ExplainStudy;
use crate::diagnose::locate::{self, Bin, Follow, Portrait, portrait};
use crate::diagnose::{CHANNEL_NAMES, Fitted, Line, Trace, Verdict, lack_of_fit};
use std::ops::Range;

/// s of a cell of the heat map.
const CELL_S: f64 = 1.0;
/// Cells of it at most.
const CELLS: u32 = 600;

/// All figures of an explanation.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// what shows the first name that a picture over a state shows
    pub portrait: Option<Portrait>,
    /// one a flight, of the axis that misfits most
    pub recorded: Vec<RecordedAndSimulated>,
    /// of the first flight, the same axis
    pub left: Option<LeftAlongTime>,
    /// against the state that the residual follows most
    pub followed: Option<Followed>,
    /// one an axis
    pub axes: Vec<AxisResidual>,
    /// of the first flight
    pub heat: Option<Heat>,
    /// of the first flight, where it repeats
    pub harmonics: Option<Harmonics>,
}

/// Specific force (m/s^2) or angular acceleration (rad/s^2) of one flight behind the weak form's kernel, body FLU.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedAndSimulated {
    /// from 0
    pub flight: usize,
    /// 0..2 force, 3..5 torque
    pub axis: usize,
    /// s
    pub time_s: Vec<f64>,
    /// what the body did
    pub recorded: Vec<f64>,
    /// what the rigid body alone makes of the commands
    pub before: Vec<f64>,
    /// what the model found makes of them
    pub after: Vec<f64>,
    /// s, from and to, where the rigid body misses by more than noise
    pub spans_s: Vec<[f64; 2]>,
}

/// Recorded less simulated, N or N m.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftAlongTime {
    /// 0..2 force, 3..5 torque
    pub axis: usize,
    /// s
    pub time_s: Vec<f64>,
    /// by the rigid body alone
    pub before: Vec<f64>,
    /// by the model found
    pub after: Vec<f64>,
}

/// Mean residual (N or N m) in bins of a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// name of the axis
    pub axis: &'static str,
    /// N or N m
    pub unit: &'static str,
    /// name of the state
    pub state: String,
    /// its unit
    pub state_unit: &'static str,
    /// by the rigid body alone
    pub before: Vec<Bin>,
    /// by the model found; `None` where it no longer follows, or where an empirical force is a curve through the bins
    pub after: Option<Vec<Bin>>,
}

/// Root mean square of an axis, in units of what is left of it after.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisResidual {
    /// name
    pub axis: &'static str,
    /// by the rigid body alone; by the model found it is 1
    pub before: f64,
}

/// Residual of each axis over time beyond what is left after, in units of that; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// s, centres of the cells
    pub time_s: Vec<f64>,
    /// one row an axis, by the rigid body alone
    pub before: Vec<Vec<f64>>,
    /// by the model found
    pub after: Vec<Vec<f64>>,
}

/// Power at the trajectory's harmonics over that beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics {
    /// name of the axis
    pub axis: &'static str,
    /// s
    pub period_s: f64,
    /// by the rigid body alone
    pub before: Vec<Line>,
    /// by the model found
    pub after: Vec<Line>,
}

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

/// Slope of the dots over that of the line from which on it is told why they differ. Set by judgement: it is seen.
const FLATTER: f64 = 0.9;

impl ExplainStudy {
    /// The numbers of all figures.
    #[must_use]
    pub fn figures(&self) -> Figures {
        let rows = ranges(&self.traces);
        let first = rows.first();
        Figures {
            portrait: self.portrait(),
            recorded: self.recorded_and_simulated(&rows),
            left: first.map(|rows| self.left_along_time(rows)),
            followed: self.followed(),
            axes: self.axes(),
            heat: first.and_then(|rows| self.heat(rows)),
            harmonics: first.and_then(|rows| self.harmonics(rows)),
        }
    }

    /// The axis with the largest share of the misfit; where none is told, that of the first picture, and where nothing is missing, the first.
    fn worst_axis(&self) -> usize {
        let shown = || self.portrait().map(|portrait| portrait.channel);
        self.located.worst_axis().or_else(shown).unwrap_or(0)
    }

    /// What is left of an axis over all flights, before, on the final model's scale of force; an empirical force is fitted to what the sensors' own part is out
    /// of.
    pub(super) fn left_before(&self, axis: usize) -> Vec<f64> {
        let before = &self.explanation.search.before;
        let left = if self.empirical.is_some() {
            before.weighted.left_of(axis)
        } else {
            before.rows.residual[axis].clone()
        };
        let scale = self.scale_over_alone();
        left.into_iter().map(|left| scale * left).collect()
    }

    /// The same after: of the model found, less the empirical force where there is one.
    pub(super) fn left_after(&self, axis: usize) -> Vec<f64> {
        let after = self.fitted_after();
        match &self.empirical {
            None => after.rows.residual[axis].clone(),
            Some(term) => term.left_of(after, &self.traces, axis),
        }
    }

    /// The fit of which it is: an empirical force without a name beside it was fitted to what the rigid body leaves.
    fn fitted_after(&self) -> &Fitted {
        let search = &self.explanation.search;
        let is_alone = self.empirical.is_some() && self.verdict() == Verdict::Unexplained;
        if is_alone { &search.before } else { &search.after }
    }

    /// Slope of the dots of a picture over airspeed as a share of that of its line, where the size is from the reconstructed flight path and
    /// the dots are clearly flatter.
    #[must_use]
    pub fn flatter(&self, of: &Portrait) -> Option<f64> {
        if !(self.explanation.search.is_by_path() && matches!(of.state, locate::Followed::Airspeed(_))) {
            return None;
        }
        let bins = || of.recorded.iter().zip(&of.model);
        let count = bins().count().max(1) as f64;
        let mean = |value: fn((&Bin, &Bin)) -> f64| bins().map(value).sum::<f64>() / count;
        let (recorded, model) = (mean(|(recorded, _)| recorded.mean), mean(|(_, model)| model.mean));
        let along = bins().map(|(a, b)| (a.mean - recorded) * (b.mean - model)).sum::<f64>();
        let slope = along / bins().map(|(_, b)| (b.mean - model).powi(2)).sum::<f64>();
        (slope < FLATTER).then_some(slope)
    }

    fn portrait(&self) -> Option<Portrait> {
        let after = &self.explanation.search.after;
        self.effects.iter().find_map(|effect| portrait(&self.traces, after, effect.id))
    }

    fn recorded_and_simulated(&self, rows: &[Range<usize>]) -> Vec<RecordedAndSimulated> {
        let axis = self.worst_axis();
        let (before, after) = (&self.explanation.search.before, self.fitted_after());
        let of_alone = self.scale_over_alone();
        // the mass or moment of inertia on the scale of what is left
        let inertia = |fitted: &Fitted, scale: f64| {
            let body = &fitted.base.vehicle.body;
            scale * if axis < 3 { body.mass_kg } else { body.inertia_kg_m2[(axis - 3, axis - 3)] }
        };
        let left = (self.left_before(axis), self.left_after(axis));
        let flights = self.traces.iter().zip(rows).enumerate();
        flights
            .filter_map(|(flight, (trace, rows))| {
                let recorded = recorded(trace, axis)?;
                let simulated = |inertia: f64, left: &[f64]| -> Vec<f64> {
                    recorded.iter().zip(left).map(|(r, e)| r - e / inertia).collect()
                };
                let spans = self.explanation.located_before.iter().flat_map(|located| &located.spans);
                let here = spans.filter(|span| span.channel == axis && span.flight == flight);
                Some(RecordedAndSimulated {
                    flight,
                    axis,
                    time_s: before.rows.time_s[rows.clone()].to_vec(),
                    before: simulated(inertia(before, of_alone), &left.0[rows.clone()]),
                    after: simulated(inertia(after, 1.0), &left.1[rows.clone()]),
                    spans_s: here.map(|span| [span.from_s, span.to_s]).collect(),
                    recorded,
                })
            })
            .collect()
    }

    /// What is left of the first flight along each axis that was compared.
    #[must_use]
    pub fn left_of_all_axes(&self) -> Vec<LeftAlongTime> {
        let rows = ranges(&self.traces);
        let is_compared = |axis: &usize| self.explanation.search.after.weighted.sigma[*axis] > 0.0;
        let axes = (0..CHANNEL_NAMES.len()).filter(is_compared);
        rows.first().map_or_else(Vec::new, |rows| axes.map(|axis| self.left_along(axis, rows)).collect())
    }

    fn left_along_time(&self, rows: &Range<usize>) -> LeftAlongTime {
        self.left_along(self.worst_axis(), rows)
    }

    fn left_along(&self, axis: usize, rows: &Range<usize>) -> LeftAlongTime {
        LeftAlongTime {
            axis,
            time_s: self.explanation.search.before.rows.time_s[rows.clone()].to_vec(),
            before: self.left_before(axis)[rows.clone()].to_vec(),
            after: self.left_after(axis)[rows.clone()].to_vec(),
        }
    }

    fn followed(&self) -> Option<Followed> {
        let most = self.explanation.located_before.as_ref()?.follows.first()?;
        let same = |follow: &&Follow| follow.channel == most.channel && follow.state == most.state;
        let after = self.explanation.located_after.as_ref().and_then(|after| after.follows.iter().find(same));
        Some(Followed {
            axis: CHANNEL_NAMES[most.channel],
            unit: if CHANNEL_NAMES[most.channel].contains("force") { "N" } else { "N m" },
            state: most.state.name(),
            state_unit: most.state.unit(),
            before: most.bins.clone(),
            after: after.filter(|_| self.empirical.is_none()).map(|after| after.bins.clone()),
        })
    }

    fn axes(&self) -> Vec<AxisResidual> {
        let search = &self.explanation.search;
        // what the empirical force leaves of what the model left
        let rms = |left: &[f64]| left.iter().map(|left| left * left).sum::<f64>().sqrt();
        let share = |axis: usize| {
            if self.empirical.is_none() {
                return 1.0;
            }
            let share = rms(&self.left_after(axis)) / rms(&search.after.weighted.left_of(axis));
            if share.is_finite() { share } else { 1.0 }
        };
        let residual = |axis: usize| {
            let after = search.after.weighted.sigma[axis] * share(axis);
            let before = self.scale_over_alone() * search.before.weighted.sigma[axis];
            AxisResidual { axis: CHANNEL_NAMES[axis], before: before / after }
        };
        self.compared_axes().map(residual).collect()
    }

    fn heat(&self, rows: &Range<usize>) -> Option<Heat> {
        let search = &self.explanation.search;
        let instants_s = &search.before.rows.time_s[rows.clone()];
        let (first, last) = (*instants_s.first()?, *instants_s.last()?);
        let time_s: Vec<f64> = (0..CELLS)
            .map(|cell| first + (f64::from(cell) + 0.5) * CELL_S)
            .take_while(|center| *center < last)
            .collect();
        let cells = |axis: usize, left: Vec<f64>| -> Vec<f64> {
            let noise = search.after.weighted.sigma[axis].max(f64::MIN_POSITIVE);
            let cell = |center: &f64| {
                let inside = instants_s
                    .iter()
                    .zip(&left[rows.clone()])
                    .filter(|(t, _)| (*t - center).abs() < 0.5 * CELL_S);
                let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), (_, r)| (sum + r * r, count + 1.0));
                if count > 0.0 { ((sum / count).sqrt() / noise - 1.0).max(0.0) } else { f64::NAN }
            };
            time_s.iter().map(cell).collect()
        };
        // torques come last, so that the rows left are the first ones
        let before = self.compared_axes().map(|axis| cells(axis, self.left_before(axis))).collect();
        let after = self.compared_axes().map(|axis| cells(axis, self.left_after(axis))).collect();
        Some(Heat { before, after, time_s })
    }

    fn harmonics(&self, rows: &Range<usize>) -> Option<Harmonics> {
        let axis = self.worst_axis();
        let after = self.explanation.lack_of_fit.as_ref()?;
        let alone = &self.explanation.search.before.rows;
        let scale = self.scale_over_alone();
        let scaled = |left: &[f64]| left.iter().map(|left| scale * left).collect::<Vec<f64>>();
        let left = alone.residual.each_ref().map(|of| of.get(rows.clone()).map_or_else(Vec::new, scaled));
        let residual = std::array::from_fn(|channel| left[channel].as_slice());
        let before = lack_of_fit(&alone.time_s[rows.clone()], residual, after.period_s)?;
        Some(Harmonics {
            axis: CHANNEL_NAMES[axis],
            period_s: after.period_s,
            before: before.lines[axis].clone(),
            after: after.lines[axis].clone(),
        })
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
