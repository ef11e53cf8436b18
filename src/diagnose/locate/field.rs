//! A force that depends on the position in the room and not on the vehicle: a smooth function of position, in world
//! axes.
//!
//! A library of vehicle effects would explain such a field by a wrong effect. The field is therefore a rival of every
//! name: it is tested on the residual of the names, and compared with their part.

use super::super::channels::{AXES, Channels, channels};
use super::super::fit::Fitted;
use super::super::measured_force::may_feel;
use super::super::trace::Trace;
use super::redness::{Redness, are_outdoors};
use super::visits::{Visits, all_along, wanders_s};
use crate::diagnose::materiality::{UNNAMED_SIDEWAYS, UNNAMED_WIND};
use crate::stats::quantile;
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Test result of a force field.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldTest {
    /// share of the residual energy left by the named effects that the field explains (0..1)
    pub gain: f64,
    /// normal deviate of the field on the residual of the named effects
    pub z: f64,
    /// p-value of the cluster test over twelve blocks, for display only: it has little power with so many columns
    pub p_cluster: f64,
    /// world axis of the force (0 x, 1 y, 2 z)
    pub component: usize,
    /// world axis along which it changes
    pub along: usize,
    /// position along it, m: centre of the bump that fits best
    pub where_m: f64,
    /// full width at half height of that bump, m
    pub extent_m: f64,
    /// its height, N, along `component`
    pub force_n: f64,
    /// energy of the residual of the named effects that the field explains, sigma squared
    pub energy: f64,
    /// energy that the field explains without the named effects, in the same unit
    pub energy_alone: f64,
    /// certain and large enough to matter
    pub certain: bool,
    /// significant, and explains more alone than all named effects together
    pub beats_named: bool,
    /// named effects whose strength is not the same everywhere in the room
    pub uneven: Vec<Uneven>,
}

/// A named effect whose strength depends on where the vehicle is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uneven {
    /// which effect
    pub id: &'static str,
    /// normal deviate from the same strength everywhere
    pub z: f64,
    /// change of the strength over one standard deviation of position, relative to it
    pub spread: f64,
}

/// Number of piecewise functions along one axis. In a room of a few metres they are half a metre apart; more would
/// follow noise.
const HATS: usize = 7;
/// Least normal deviate of a field. It is above that of a name, because eight directions and places of six columns each
/// are tried, and the largest deviate reaches four on flights without a field.
const FIELD_Z: f64 = 5.5;
/// Pairs of the force's axis and the axis along which it changes. A vertical force that changes with height is left
/// out, because ground, ceiling and tether cause it.
const TRIED: [(usize, usize); 8] = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (0, 2), (1, 2)];
/// Least share of the residual energy. Set by judgement; measured only together with all conditions of a finding (see
/// `Gates`).
const FIELD_GAIN: f64 = 0.01;
/// Normal deviate beyond which the strength of an effect depends on the place. Set by judgement; measured only
/// together with all conditions of a finding (see `Gates`).
const UNEVEN_Z: f64 = 5.5;
/// Relative change of the strength beyond which it depends on the place. Set by judgement; measured only together
/// with all conditions of a finding (see `Gates`).
const UNEVEN_SPREAD: f64 = 0.25;

/// Tests for a force field. `None` if position or attitude are not known. `named_energy` is the energy that the named
/// effects explain, in sigma squared of their residual, and `redness` what wanders by itself beside them.
#[must_use]
pub fn field_test(
    traces: &[Trace],
    (before, after): (&Fitted, &Fitted),
    (named_energy, redness): (f64, &[Redness]),
) -> Option<FieldTest> {
    if traces.is_empty() || !traces.iter().all(|trace| trace.known.position && trace.known.attitude) {
        return None;
    }
    let ranges: Vec<(f64, f64)> = (0..3).map(|axis| position_range(traces, axis)).collect();
    let tested: Vec<_> = TRIED
        .par_iter()
        .filter_map(|&(component, along)| {
            let columns = hats(traces, (component, along), ranges[along]);
            let evidence = after.weighted.test(&columns)?;
            Some((component, along, evidence, columns))
        })
        .collect();
    let (component, along, evidence, columns) = tested.into_iter().max_by(|a, b| {
        let seen = |z: f64| z > FIELD_Z;
        seen(a.2.z).cmp(&seen(b.2.z)).then(a.2.energy.total_cmp(&b.2.energy))
    })?;
    let (where_m, extent_m, force_n) =
        bump(traces, after, (component, along), ranges[along]).unwrap_or((0.0, 0.0, 0.0));
    // wind makes less than this outdoors, but what a place explains better than the names do speaks against them all the same
    let least = if component < 2 && are_outdoors(traces) { UNNAMED_WIND } else { UNNAMED_SIDEWAYS };
    let share = force_n.abs() / after.weight_n();
    let is_field = evidence.z > FIELD_Z
        && evidence.gain >= FIELD_GAIN
        && share >= UNNAMED_SIDEWAYS
        && may_feel(after, &columns, &evidence)
        && all_along(
            after,
            &columns,
            &evidence.theta,
            &Visits {
                at_m: &positions(traces, along),
                range_m: ranges[along],
                wanders_s: wanders_s(redness, component),
            },
        );
    let energy_alone = if is_field { taken(before, after, &columns) } else { evidence.energy };
    Some(FieldTest {
        gain: evidence.gain,
        z: evidence.z,
        p_cluster: evidence.p_cluster,
        component,
        along,
        where_m,
        extent_m,
        force_n,
        energy: evidence.energy,
        energy_alone,
        certain: is_field && share >= least,
        beats_named: is_field && energy_alone > named_energy,
        uneven: uneven(traces, after),
    })
}

/// Position of each row along a world axis, m.
fn positions(traces: &[Trace], axis: usize) -> Vec<f64> {
    let of = |trace: &Trace, center: usize| trace.states[center].position_m[axis];
    traces.iter().flat_map(|trace| trace.centers.iter().map(move |&center| of(trace, center))).collect()
}

/// Range of a world axis that contains 96 % of the rows, m.
fn position_range(traces: &[Trace], axis: usize) -> (f64, f64) {
    let mut values = positions(traces, axis);
    values.sort_by(f64::total_cmp);
    let at = |percent: usize| quantile(&values, (percent, 100)).unwrap_or(0.0);
    (at(2), at(98))
}

/// `K` of a world force along `component` whose strength is `shape` of the position along `along`.
fn force_column(
    traces: &[Trace],
    (component, along): (usize, usize),
    shape: impl Fn(f64) -> f64,
) -> Channels {
    let mut out = Channels::default();
    let direction = Vector3::from_fn(|axis, _| if axis == component { 1.0 } else { 0.0 });
    for trace in traces {
        let forces: Vec<Vector3<f64>> = trace
            .states
            .iter()
            .zip(&trace.usable)
            .map(|(state, usable)| {
                if *usable {
                    state.attitude.inverse_transform_vector(&direction) * shape(state.position_m[along])
                } else {
                    Vector3::zeros()
                }
            })
            .collect();
        let torque = std::array::from_fn(|_| vec![0.0; trace.rows()]);
        let both = channels(trace, trace.weak_vector(0, &forces), torque);
        out.iter_mut().zip(both).for_each(|(to, from)| to.extend(from));
    }
    out
}

/// Smooth piecewise functions (hats) whose sum is constant. A constant force belongs to wind and tilt, so one hat is
/// left out and the mean of each is subtracted.
fn hats(traces: &[Trace], place: (usize, usize), (low, high): (f64, f64)) -> Vec<Channels> {
    let spacing = ((high - low) / (HATS - 1) as f64).max(1e-3);
    let hat = |index: usize, at: f64| {
        let from = (at.clamp(low, high) - low - index as f64 * spacing) / spacing;
        if from.abs() < 1.0 { (0.5 * PI * from).cos().powi(2) } else { 0.0 }
    };
    let positions = positions(traces, place.1);
    (1..HATS)
        .map(|index| {
            let mean =
                positions.iter().map(|at| hat(index, *at)).sum::<f64>() / positions.len().max(1) as f64;
            force_column(traces, place, |at| hat(index, at) - mean)
        })
        .collect()
}

/// Centre, full width at half height (m) and height (N) of the Gaussian bump that explains most.
fn bump(
    traces: &[Trace],
    fitted: &Fitted,
    place: (usize, usize),
    (low, high): (f64, f64),
) -> Option<(f64, f64, f64)> {
    const CENTERS: usize = 25;
    const WIDTHS: [f64; 4] = [0.04, 0.08, 0.15, 0.3];
    // no window of the recording resolves less
    let range = (high - low).max(1e-3);
    let tried: Vec<(f64, f64)> = WIDTHS
        .iter()
        .flat_map(|width| {
            (0..CENTERS).map(move |i| (low + range * i as f64 / (CENTERS - 1) as f64, width * range))
        })
        .collect();
    let best = tried
        .into_par_iter()
        .filter_map(|(center, width)| {
            let column = force_column(traces, place, |at| (-0.5 * ((at - center) / width).powi(2)).exp());
            let (_, partialled) = fitted.weighted.partialled(&[column])?;
            let column = partialled.column(0);
            let norm = column.norm_squared();
            let along = column.dot(&fitted.weighted.left);
            Some((along * along / norm, center, width, along / norm))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    // full width at half height of a Gaussian
    let full = 2.0 * (2.0 * std::f64::consts::LN_2).sqrt();
    Some((best.1, full * best.2, best.3))
}

/// Energy of the rigid body's residual that the columns explain, in sigma squared of the residual of the names.
fn taken(before: &Fitted, after: &Fitted, columns: &[Channels]) -> f64 {
    let Some((_, partialled)) = before.weighted.partialled(columns) else { return 0.0 };
    let left = &before.weighted.left;
    let normal: DMatrix<f64> = partialled.tr_mul(&partialled);
    let Some(factor) = normal.cholesky() else { return 0.0 };
    let theta: DVector<f64> = factor.solve(&partialled.tr_mul(left));
    let rest = left - &partialled * theta;
    let rows = before.rows.len();
    let of_force = after.base.scale_over(&before.base);
    (0..AXES)
        .filter(|&channel| after.weighted.sigma[channel] > 0.0)
        .map(|channel| {
            let part = |v: &DVector<f64>| v.rows(channel * rows, rows).norm_squared();
            let scale = of_force * before.weighted.sigma[channel] / after.weighted.sigma[channel];
            (part(left) - part(&rest)) * scale * scale
        })
        .sum()
}

/// Named effects whose strength changes with the horizontal position.
fn uneven(traces: &[Trace], after: &Fitted) -> Vec<Uneven> {
    let place = |axis: usize| -> Vec<f64> {
        let values = positions(traces, axis);
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let std = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt().max(1e-6);
        values.into_iter().map(|v| (v - mean) / std).collect()
    };
    let places = [place(0), place(1)];
    let mut out = Vec::new();
    let mut first = 0;
    for present in &after.base.effects {
        let own = &after.rows.effects[first..first + present.free.len()];
        first += present.free.len();
        let columns: Vec<Channels> = own
            .iter()
            .flat_map(|column| {
                places.iter().map(move |place| {
                    std::array::from_fn(|channel| {
                        column[channel].iter().zip(place).map(|(value, at)| value * at).collect()
                    })
                })
            })
            .collect();
        let Some(evidence) = after.weighted.test(&columns) else { continue };
        let spread = evidence
            .theta
            .iter()
            .enumerate()
            .filter_map(|(index, theta)| {
                let slot = *present.free.get(index / places.len())?;
                let nothing =
                    if present.signature.role.which.is_some() { present.signature.nothing } else { 0.0 };
                let strength = (present.values[slot] - nothing).abs();
                (strength > 0.0).then(|| theta.abs() / strength)
            })
            .fold(0.0, f64::max);
        if evidence.z > UNEVEN_Z && spread > UNEVEN_SPREAD {
            out.push(Uneven { id: present.id(), z: evidence.z, spread });
        }
    }
    out
}
