//! The residual force as a piecewise linear function of one measured quantity, for residuals without a known mechanism.
//!
//! The term is no mechanism. It is valid inside the flown range and zero outside.

use super::channels::{Channels, Nuisance, SECOND, append, force_channels};
use super::evidence::weighted;
use super::explain::ExplainSettings;
use super::explanation::{Explanation, Verdict};
use super::fit::Fitted;
use super::trace::Trace;
use super::trace_error::TraceError;
use crate::physics::{State, Wrench};
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;

/// The quantity on which the force depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// world x, y or z of the vehicle (m): a force fixed in the room
    Position(usize),
    /// velocity along body x, y or z (m/s): a force fixed in the body
    Velocity(usize),
}

impl Along {
    const ALL: [Self; 6] = [
        Self::Position(0),
        Self::Position(1),
        Self::Position(2),
        Self::Velocity(0),
        Self::Velocity(1),
        Self::Velocity(2),
    ];

    /// As in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Position(axis) => ["world_x", "world_y", "world_z"][axis.min(2)],
            Self::Velocity(axis) => ["body_velocity_x", "body_velocity_y", "body_velocity_z"][axis.min(2)],
        }
    }

    /// Unit of the quantity.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Position(_) => "m",
            Self::Velocity(_) => "m/s",
        }
    }

    fn of(self, state: &State) -> f64 {
        match self {
            Self::Position(axis) => state.position_m[axis],
            Self::Velocity(axis) => state.body_velocity_m_s()[axis],
        }
    }

    /// The force's axis in the body.
    fn axis(self, state: &State, axis: usize) -> Vector3<f64> {
        let unit = Vector3::ith(axis, 1.0);
        match self {
            Self::Position(_) => state.attitude.inverse_transform_vector(&unit),
            Self::Velocity(_) => unit,
        }
    }
}

/// An empirical term, not a mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct Empirical {
    /// the quantity on which it depends
    pub along: Along,
    /// values of that quantity, ascending; the first and last bound what was flown
    pub knots: Vec<f64>,
    /// N at each knot, linear between them: world x y z over position, body x y z over velocity
    pub force_n: Vec<Vector3<f64>>,
    /// change of the rigid body's mass by the term, kg
    pub mass_change_kg: f64,
    /// share of the energy of the force residual that it predicts in parts of the flight to which it was not fitted
    /// (0..1)
    pub gain: f64,
}

/// Number of knots with which the quantity is chosen. They are a metre apart in a room of 12 m; the cross-validation
/// refuses what more of them would fit to noise.
const KNOTS: usize = 13;
const OTHER_KNOTS: [usize; 2] = [7, 25];
/// Parts of the flight in the cross-validation. Fewer leave too little to fit, more are as short as what the residual
/// is correlated over.
const FOLDS: usize = 6;
/// Least share of the residual energy that a term must predict in the cross-validation. With less the term would not
/// be seen in a prediction.
const LEAST_GAIN: f64 = 0.02;
/// Strength of the prior towards zero, as a share of the mean information. It keeps knots without data at zero and
/// changes those with data by a hundredth.
const RIDGE: f64 = 1e-2;

impl Empirical {
    /// The best term for the residual of an explanation. `None` if everything is explained, or if no term predicts 2 %
    /// of the residual energy in the cross-validation. `flights` are those that were explained.
    ///
    /// # Errors
    /// [`TraceError`] where streams are missing.
    pub fn fit(
        explanation: &Explanation,
        flights: &[Signals],
        vehicle: &Vehicle,
        settings: &ExplainSettings,
    ) -> Result<Option<Self>, TraceError> {
        let fitted = match explanation.verdict {
            Verdict::NothingMissing | Verdict::Explained => return Ok(None),
            Verdict::PartlyExplained => &explanation.search.after,
            Verdict::Unexplained => &explanation.search.before,
        };
        let traces: Vec<Trace> = flights
            .iter()
            .map(|signals| Trace::new(signals, vehicle, settings.half_width_s))
            .collect::<Result<_, _>>()?;
        let positions = traces.iter().all(|trace| trace.known.position && trace.known.attitude);
        let velocities = traces.iter().all(|trace| trace.known.velocity && trace.known.attitude);
        let known = |along: &Along| if matches!(along, Along::Position(_)) { positions } else { velocities };
        let best_of = |choices: Vec<(Along, usize)>| {
            choices
                .into_par_iter()
                .filter_map(|(along, knots)| fitted_term(&traces, fitted, along, knots))
                .max_by(|a, b| a.gain.total_cmp(&b.gain))
        };
        let all = Along::ALL.into_iter().filter(known).map(|along| (along, KNOTS)).collect();
        let best = best_of(all).map(|first| {
            let others = best_of(OTHER_KNOTS.map(|knots| (first.along, knots)).to_vec());
            others.filter(|other| other.gain > first.gain).unwrap_or(first)
        });
        Ok(best.filter(|term| term.gain > LEAST_GAIN))
    }

    /// Force at this state, body, N. Zero outside what was flown.
    #[must_use]
    pub fn force_n(&self, state: &State) -> Vector3<f64> {
        let Some((left, share)) = self.place(self.along.of(state)) else { return Vector3::zeros() };
        let force = self.force_n[left].lerp(&self.force_n[left + 1], share);
        (0..3).map(|axis| self.along.axis(state, axis) * force[axis]).sum()
    }

    /// The force as a function of time (s) and state for simulations, in addition to the model.
    pub fn push(&self) -> impl Fn(f64, &State) -> Wrench + '_ {
        |_, state| Wrench { force_n: self.force_n(state), torque_nm: Vector3::zeros() }
    }

    /// Weak form of the force along a flight, body x y z, N.
    #[must_use]
    pub(super) fn weak_force(&self, trace: &Trace) -> [Vec<f64>; 3] {
        let forces: Vec<Vector3<f64>> = trace.states.iter().map(|state| self.force_n(state)).collect();
        trace.weak_vector(0, &forces)
    }

    /// Residual (N, N m) of a channel of the flights to which it was fitted, without the part of the nuisances.
    #[must_use]
    pub fn left_of(&self, fitted: &Fitted, traces: &[Trace], channel: usize) -> Vec<f64> {
        let mut own = Channels::default();
        for trace in traces {
            append(&mut own, &force_channels(trace, self.weak_force(trace)));
        }
        let sigma = &fitted.weighted.sigma;
        let share = fitted.weighted.project(&weighted(&own, sigma));
        let left = &fitted.weighted.left - share;
        let rows = fitted.rows.len();
        left.rows(channel * rows, rows).iter().map(|value| value * sigma[channel]).collect()
    }

    fn place(&self, value: f64) -> Option<(usize, f64)> {
        place(&self.knots, value)
    }
}

/// Knot on the left and share of the way to the next; `None` outside.
fn place(knots: &[f64], value: f64) -> Option<(usize, f64)> {
    let (first, last) = (*knots.first()?, *knots.last()?);
    if !(first..=last).contains(&value) {
        return None;
    }
    let left = knots.partition_point(|knot| *knot <= value).clamp(1, knots.len() - 1) - 1;
    Some((left, (value - knots[left]) / (knots[left + 1] - knots[left]).max(f64::MIN_POSITIVE)))
}

/// Knots with the same number of rows between neighbours.
fn knots_of(traces: &[Trace], along: Along, count: usize) -> Option<Vec<f64>> {
    let mut values: Vec<f64> = traces
        .iter()
        .flat_map(|trace| trace.centers.iter().map(|&center| along.of(&trace.states[center])))
        .collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let mut knots: Vec<f64> = (0..count).map(|k| values[last * k / (count - 1)]).collect();
    knots.dedup_by(|a, b| *a - *b < 1e-6);
    (knots.len() >= 4).then_some(knots)
}

/// Sums of one stretch of the flights.
struct Fold {
    normal: DMatrix<f64>,
    moment: DVector<f64>,
    energy: f64,
}

fn fitted_term(traces: &[Trace], fitted: &Fitted, along: Along, count: usize) -> Option<Empirical> {
    let knots = knots_of(traces, along, count)?;
    let plain: Vec<DVector<f64>> = columns(traces, along, &knots)
        .iter()
        .map(|column| weighted(column, &fitted.weighted.sigma))
        .collect();
    let (rows, size) = (fitted.rows.len(), plain.len());
    // together with the nuisances, which took a part of the force while it was not there
    let together = DMatrix::from_columns(
        &plain.iter().map(|column| fitted.weighted.project(column)).collect::<Vec<_>>(),
    );
    let left = &fitted.weighted.left;
    let readings = (0..3).chain(SECOND..SECOND + 3);
    let folds: Vec<Fold> = (0..FOLDS)
        .map(|fold| {
            let (from, to) = (rows * fold / FOLDS, rows * (fold + 1) / FOLDS);
            let mut sums =
                Fold { normal: DMatrix::zeros(size, size), moment: DVector::zeros(size), energy: 0.0 };
            for channel in readings.clone() {
                let part = together.rows(channel * rows + from, to - from);
                let y = left.rows(channel * rows + from, to - from);
                sums.normal += part.tr_mul(&part);
                sums.moment += part.tr_mul(&y);
                sums.energy += y.norm_squared();
            }
            sums
        })
        .collect();
    let solve = |without: Option<usize>| {
        let (mut normal, mut moment) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (_, fold) in folds.iter().enumerate().filter(|(index, _)| Some(*index) != without) {
            normal += &fold.normal;
            moment += &fold.moment;
        }
        let ridge = RIDGE * normal.trace() / size as f64;
        (0..size).for_each(|index| normal[(index, index)] += ridge);
        normal.cholesky().map(|factor| factor.solve(&moment))
    };
    let (mut after, mut before) = (0.0, 0.0);
    for (index, fold) in folds.iter().enumerate() {
        let theta = solve(Some(index))?;
        after += fold.energy - 2.0 * theta.dot(&fold.moment) + theta.dot(&(&fold.normal * &theta));
        before += fold.energy;
    }
    let theta = solve(None)?;
    let force_n = theta.as_slice().chunks_exact(3).map(Vector3::from_column_slice).collect();
    let mass = fitted.rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Mass);
    let taken = fitted.weighted.part_in(&(DMatrix::from_columns(&plain) * theta));
    let mass_change_kg = mass.map_or(0.0, |mass| -taken[mass]);
    let gain = 1.0 - after / before.max(f64::MIN_POSITIVE);
    Some(Empirical { along, knots, force_n, mass_change_kg, gain })
}

/// Weak-form force rows of a newton at each knot and axis.
fn columns(traces: &[Trace], along: Along, knots: &[f64]) -> Vec<Channels> {
    let mut out: Vec<Channels> = vec![Channels::default(); 3 * knots.len()];
    for trace in traces {
        let places: Vec<Option<(usize, f64)>> =
            trace.states.iter().map(|state| place(knots, along.of(state))).collect();
        for knot in 0..knots.len() {
            for axis in 0..3 {
                let force: Vec<Vector3<f64>> = trace
                    .states
                    .iter()
                    .zip(&places)
                    .map(|(state, place)| match place {
                        Some((left, share)) if *left == knot => along.axis(state, axis) * (1.0 - share),
                        Some((left, share)) if left + 1 == knot => along.axis(state, axis) * *share,
                        _ => Vector3::zeros(),
                    })
                    .collect();
                let force = trace.weak_vector(0, &force);
                append(&mut out[3 * knot + axis], &force_channels(trace, force));
            }
        }
    }
    out
}
