//! The slow error of the velocity estimate, which acts on the forces that go with airspeed.
//!
//! An autopilot integrates accelerometer noise and an attitude that leans, and corrects the velocity within seconds. What is
//! left is slow and does not average out over a flight. With a drag it is a slow force, of the kind that a change of mass or
//! a sagging battery makes as well.

use super::along::wrench_along;
use super::base::Base;
use super::channels::{Nuisance, NuisanceColumn, channels};
use super::rotors::RotorMotion;
use super::trace::Trace;
use crate::physics::{Model, Wrench};
use nalgebra::Vector3;
use std::ops::Range;

/// Standard deviation of the vertical error, m/s: that of PX4's estimate against the truth of its simulator, 0.13 to 0.15
/// m/s in three flights.
const STD_M_S: f64 = 0.15;
/// Time between the knots of the error, s; correlation times of 2 to 3 s were measured in the same flights.
const KNOTS_S: f64 = 3.0;
/// Knots of all flights together, at most: each is a column of the fit, so a long recording has them further apart. Chosen; not
/// measured.
const MOST_KNOTS: usize = 60;
/// Change of velocity that gives the slope of the force, m/s. Chosen; not measured.
const STEP_M_S: f64 = 0.1;

/// One column for each knot of one of `flights` flights, N per m/s of vertical velocity (world); none where no force goes with
/// airspeed.
pub(super) fn velocity_error(
    (trace, flights): (&Trace, usize),
    (base, model): (&Base, &Model),
    commanded: &RotorMotion,
    by_commands: &[Wrench],
) -> Vec<NuisanceColumn> {
    let of_air = base.present.iter().any(|term| term.signature.role.of_air);
    let (Some(first), Some(last)) = (trace.centers.first(), trace.centers.last()) else { return Vec::new() };
    if !of_air || !trace.known.velocity {
        return Vec::new();
    }
    let mut states = trace.states.clone();
    states.iter_mut().for_each(|state| state.velocity_m_s += Vector3::z() * STEP_M_S);
    let shifted = trace.reading(states, trace.specific_force_m_s2().map(<[Vector3<f64>]>::to_vec));
    let slope: Vec<Vector3<f64>> = wrench_along(model, &shifted, commanded)
        .iter()
        .zip(by_commands)
        .map(|(shifted, plain)| (shifted.force_n - plain.force_n) / STEP_M_S)
        .collect();
    let (from_s, to_s) = (trace.grid.time_s(*first), trace.grid.time_s(*last));
    let most = (MOST_KNOTS / flights.max(1)).max(2) as f64;
    let knots = ((to_s - from_s) / KNOTS_S).ceil().clamp(1.0, most);
    let apart_s = (to_s - from_s).max(trace.grid.step_s) / knots;
    let mut out = Vec::new();
    let mut at_s = from_s;
    while at_s < to_s + 0.5 * apart_s {
        let hat = |index: usize| (1.0 - (trace.grid.time_s(index) - at_s).abs() / apart_s).max(0.0);
        let rows = rows_near(trace, at_s - apart_s, at_s + apart_s);
        let force = weak_force(trace, rows.clone(), |index| slope[index] * hat(index));
        let no_torque = std::array::from_fn(|_| vec![0.0; rows.len()]);
        out.push(NuisanceColumn {
            nuisance: Nuisance::VelocityError,
            values: channels(trace, force, no_torque),
            first_row: rows.start,
            prior_std: Some(STD_M_S),
            considered: None,
        });
        at_s += apart_s;
    }
    out
}

/// The rows whose test function overlaps with this time, s.
fn rows_near(trace: &Trace, from_s: f64, to_s: f64) -> Range<usize> {
    let reach_s = (trace.kernel.half_count as f64 + 1.0) * trace.grid.step_s;
    let before = |time_s: f64| trace.centers.partition_point(|&center| trace.grid.time_s(center) < time_s);
    let first = before(from_s - reach_s);
    first..before(to_s + reach_s).max(first)
}

/// `K` of a force at some rows, axis by axis; `of` gives the force at an instant.
fn weak_force(trace: &Trace, rows: Range<usize>, of: impl Fn(usize) -> Vector3<f64>) -> [Vec<f64>; 3] {
    let centers = &trace.centers[rows];
    let (Some(first), Some(last)) = (centers.first(), centers.last()) else { return Default::default() };
    let (from, half) = (first - trace.kernel.half_count, trace.kernel.half_count);
    let force: Vec<Vector3<f64>> = (from..=last + half).map(of).collect();
    let centers: Vec<usize> = centers.iter().map(|center| center - from).collect();
    std::array::from_fn(|axis| {
        let column: Vec<f64> = force.iter().map(|force| force[axis]).collect();
        trace.kernel.apply(0, &column, &centers)
    })
}
