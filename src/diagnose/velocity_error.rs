//! The slow error of the velocity estimate, which acts on the forces that go with airspeed and on the kinematic reading.
//!
//! An autopilot integrates accelerometer noise and an attitude that leans, and corrects the velocity within seconds. What is
//! left is slow and does not average out over a flight. With a drag it is a slow force, of the kind that a change of mass or
//! a sagging battery makes as well.
//!
//! Let `c` be what the measured velocity lacks of the true one (world, m/s), and `R` the attitude. The true force is
//! `F(v + c) = F(v) + F_v c`, `F_v` by finite difference. The true specific force is what the kinematics give of `v + c`:
//! `R'(v' + g e_z) + R'c'`. The residual is `m a - F` of what was measured, and the true one is zero. It is therefore
//! `F_v c` by an accelerometer, and `F_v c - m R'c'` by the kinematics. In weak form `R'c'` is `K1(R'c) + K(w x R'c)`.
//! Between knots the error is a straight line, and the derivative a constant there.

use super::base::Base;
use super::channels::{Channels, Nuisance, NuisanceColumn, SECOND, force_channels};
use super::model_wrench::wrench_along;
use super::rotors::RotorMotion;
use super::trace::Trace;
use crate::physics::Model;
use crate::signals::VelocityHeldBy;
use nalgebra::Vector3;
use std::ops::Range;

/// Root mean square of the vertical error, m/s: that of PX4's estimate against the truth of its simulator, 0.13 to 0.15
/// m/s in three flights.
const RMS_M_S: f64 = 0.15;
/// The same that the position leaves, m/s: PX4's estimate and the receiver in nine simulated flights differ by 0.08 m/s over two seconds, with
/// 0.04 m/s of noise of the receiver.
const RMS_BY_POSITION_M_S: f64 = 0.08;
/// The same where a motion capture system gives the height: it places a vehicle within millimetres many times a
/// second.
const RMS_BY_POSE_M_S: f64 = 0.02;
/// Mean variance of a straight line between two independent knots, over that of a knot: the mean of `(1 - s)^2 + s^2` for s
/// from 0 to 1.
const BETWEEN_KNOTS: f64 = 2.0 / 3.0;
/// Time between the knots of the error, s; correlation times of 2 to 3 s were measured in the same flights.
const KNOTS_S: f64 = 3.0;
/// Knots of all flights together, at most: each is a column of the fit, so a long recording has them further apart.
/// It bounds the time.
const MOST_KNOTS: usize = 60;
/// Change of velocity that gives the slope of the force, m/s. Drag is nearly linear over it, and it is large against
/// rounding.
const STEP_M_S: f64 = 0.1;

/// One column for each knot of one of `flights` flights, N per m/s of vertical velocity (world) that the measured one lacks;
/// none where no force goes with airspeed.
pub(super) fn velocity_error(
    (trace, flights): (&Trace, usize),
    (base, model): (&Base, &Model),
    commanded: &RotorMotion,
    by_commands_n: &[Vector3<f64>],
) -> Vec<NuisanceColumn> {
    let of_air = base.effects.iter().any(|term| term.signature.role.of_air);
    let (Some(first), Some(last)) = (trace.centers.first(), trace.centers.last()) else { return Vec::new() };
    if !of_air || !trace.known.velocity {
        return Vec::new();
    }
    let slope = slope(trace, model, commanded, by_commands_n);
    let knots = Knots::of((trace.grid.time_s(*first), trace.grid.time_s(*last)), trace.grid.step_s, flights);
    let rms_m_s = rms_m_s(trace.velocity_held_by);
    let mass_kg = base.vehicle.body.mass_kg;
    (0..=knots.count)
        .map(|knot| NuisanceColumn {
            nuisance: Nuisance::VelocityError,
            values: knots.column(knot, trace, (mass_kg, &slope)),
            first_row: knots.rows(knot, trace).start,
            prior_std: Some(rms_m_s / BETWEEN_KNOTS.sqrt()),
            prior_mean: 0.0,
            considered: None,
        })
        .collect()
}

/// Root mean square of the slow error of a vertical velocity, m/s.
fn rms_m_s(held_by: VelocityHeldBy) -> f64 {
    match held_by {
        VelocityHeldBy { pose: Some(true), .. } => RMS_BY_POSE_M_S,
        VelocityHeldBy { position: true, .. } => RMS_BY_POSITION_M_S,
        _ => RMS_M_S,
    }
}

/// Change of the force with the vertical velocity at each grid instant, body, N per m/s.
fn slope(
    trace: &Trace,
    model: &Model,
    commanded: &RotorMotion,
    by_commands_n: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    let mut states = trace.states.to_vec();
    states.iter_mut().for_each(|state| state.velocity_m_s += Vector3::z() * STEP_M_S);
    let shifted = trace.reading(states, trace.specific_force_m_s2().cloned());
    wrench_along(model, &shifted, commanded)
        .iter()
        .zip(by_commands_n)
        .map(|(shifted, plain_n)| (shifted.force_n - plain_n) / STEP_M_S)
        .collect()
}

/// Instants between which the error is a straight line.
struct Knots {
    from_s: f64,
    apart_s: f64,
    /// spans between them
    count: usize,
}

impl Knots {
    /// Over the rows of one of `flights` flights.
    fn of((from_s, to_s): (f64, f64), step_s: f64, flights: usize) -> Self {
        let most = (MOST_KNOTS / flights.max(1)).max(2);
        let count = (1..most).find(|count| *count as f64 * KNOTS_S >= to_s - from_s).unwrap_or(most);
        Self { from_s, apart_s: (to_s - from_s).max(step_s) / count as f64, count }
    }

    fn at_s(&self, knot: usize) -> f64 {
        self.from_s + knot as f64 * self.apart_s
    }

    /// The error at an instant per unit of it at a knot (-).
    fn hat(&self, knot: usize, time_s: f64) -> f64 {
        (1.0 - (time_s - self.at_s(knot)).abs() / self.apart_s).max(0.0)
    }

    /// Rows that a knot reaches.
    fn rows(&self, knot: usize, trace: &Trace) -> Range<usize> {
        let half_s = trace.kernel.half_count as f64 * trace.grid.step_s;
        let away = |center: &usize| trace.grid.time_s(*center) - self.at_s(knot);
        let reach_s = self.apart_s + half_s;
        let first = trace.centers.partition_point(|center| away(center) < -reach_s);
        first..trace.centers.partition_point(|center| away(center) <= reach_s)
    }

    /// Its values in these rows.
    fn column(&self, knot: usize, trace: &Trace, (mass_kg, slope): (f64, &[Vector3<f64>])) -> Channels {
        let rows = self.rows(knot, trace);
        let reach = trace.reach(&rows);
        let hat: Vec<f64> = reach.clone().map(|index| self.hat(knot, trace.grid.time_s(index))).collect();
        let force: Vec<Vector3<f64>> =
            slope[reach].iter().zip(&hat).map(|(slope, hat)| slope * *hat).collect();
        let mut out = force_channels(trace, trace.weak_vector_in(0, &force, &rows));
        let Some(first) = kinematic(trace) else { return out };
        let error: Vec<Vector3<f64>> = hat.iter().map(|hat| Vector3::z() * *hat).collect();
        let turned = trace.weak_acceleration(&error, &Vector3::zeros(), &rows);
        for (out, turned) in out[first..].iter_mut().zip(&turned) {
            out.iter_mut().zip(turned).for_each(|(out, turned)| *out -= mass_kg * turned);
        }
        out
    }
}

/// First channel of the force that the kinematics measure.
fn kinematic(trace: &Trace) -> Option<usize> {
    let measured = trace.known.attitude && trace.known.velocity;
    measured.then_some(if trace.has_accelerometer() { SECOND } else { 0 })
}

#[cfg(test)]
#[path = "velocity_error_tests.rs"]
mod tests;
