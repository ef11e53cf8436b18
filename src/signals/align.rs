//! Offsets between streams, from kinematics alone.
//!
//! The inertial unit's stamps are the reference. An attitude that is late by `d` leaves
//! `-D(R^T e) - K(R^T e x w)` over (D, K: the weak form's maps), a velocity that is late leaves
//! `-D(R^T v) + K(w x R^T v + g R^T e_z - a)`. The shift that leaves least is found by Gauss-Newton on
//! its derivative, and its standard error from the residual's own autocovariance.

use super::{Grid, WeakKernel, cubic_onto};
use crate::recording::Stream;
use nalgebra::{DMatrix, DVector, Quaternion, UnitQuaternion, Vector3};

/// An offset of one stream against the inertial unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamOffset {
    /// s; positive: the stream's samples carry a stamp that is too late by this
    pub late_s: f64,
    /// s, standard error
    pub std_s: f64,
    /// whether the offset was corrected
    pub repaired: bool,
}

/// Largest offset between streams that is corrected, s. A larger one is no latency but a stamp of another meaning,
/// and is told instead.
const LARGEST_S: f64 = 0.1;
/// Largest standard error of an offset that is corrected, s. A worse estimate would bring more error than it removes.
const LEAST_PRECISE_S: f64 = 0.005;
/// Longest pause of the inertial unit's rates with which others are compared, s. Interpolated rates over longer
/// pauses are no measurement.
const LONGEST_PAUSE_S: f64 = 0.3;

/// Attitudes on the grid from a quaternion stream shifted by `shift_s`; `None` with too few samples.
#[must_use]
pub fn attitudes_onto(stream: &Stream, shift_s: f64, grid: &Grid) -> Option<Vec<UnitQuaternion<f64>>> {
    let flat = cubic_onto(&continuous_sign(stream), shift_s, grid)?;
    Some(
        flat.chunks_exact(4)
            .map(|q| UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3])))
            .collect(),
    )
}

/// Quaternions with continuous signs: q and -q are the same attitude.
fn continuous_sign(stream: &Stream) -> Stream {
    let mut out = stream.clone();
    for i in 1..out.len() {
        let (done, rest) = out.values.split_at_mut(4 * i);
        let before = &done[4 * (i - 1)..];
        let now = &mut rest[..4];
        if before.iter().zip(now.iter()).map(|(a, b)| a * b).sum::<f64>() < 0.0 {
            now.iter_mut().for_each(|value| *value = -*value);
        }
    }
    out
}

/// Three-vectors on the grid by cubic spline, the stream shifted by `shift_s`.
#[must_use]
pub fn vectors_onto(stream: &Stream, shift_s: f64, grid: &Grid) -> Option<Vec<Vector3<f64>>> {
    let flat = cubic_onto(stream, shift_s, grid)?;
    Some(flat.chunks_exact(3).map(|v| Vector3::new(v[0], v[1], v[2])).collect())
}

/// Offset of an attitude stream against the rates on the grid.
#[must_use]
pub fn attitude_offset(
    attitude: &Stream,
    rate: &[Vector3<f64>],
    frame: &AlignFrame<'_>,
) -> Option<StreamOffset> {
    estimate(frame.centers.len(), |shift_s| {
        let attitude = attitudes_onto(attitude, shift_s, frame.grid)?;
        let mut residual = Vec::with_capacity(9 * frame.centers.len());
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let seen: Vec<Vector3<f64>> =
                attitude.iter().map(|q| q.inverse_transform_vector(&axis)).collect();
            // d/dt (R^T e) = R^T e x w
            let turning: Vec<Vector3<f64>> = seen.iter().zip(rate).map(|(e, w)| e.cross(w)).collect();
            frame.difference(&seen, &turning, &mut residual);
        }
        if frame.askew {
            let columns = [Vector3::x(), Vector3::y(), Vector3::z()].map(|angle| {
                let mut column = Vec::with_capacity(residual.len());
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    let seen = attitude.iter().map(|q| q.inverse_transform_vector(&axis));
                    let turned: Vec<Vector3<f64>> =
                        seen.zip(rate).map(|(e, w)| e.cross(&angle.cross(w))).collect();
                    frame.difference(&vec![Vector3::zeros(); turned.len()], &turned, &mut column);
                }
                column
            });
            partial_out(&mut residual, &columns);
        }
        Some(residual)
    })
}

/// Offset of a stream of body rates against the inertial unit's own, for rates that another message brings: an autopilot's
/// attitude has stamps and filters of its own.
#[must_use]
pub fn rate_offset(rate: &Stream, inertial: &Stream, frame: &AlignFrame<'_>) -> Option<StreamOffset> {
    let pause = inertial.time_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    if pause > LONGEST_PAUSE_S {
        return None;
    }
    let measured = vectors_onto(inertial, 0.0, frame.grid)?;
    let none = vec![Vector3::zeros(); measured.len()];
    estimate(frame.centers.len(), |shift_s| {
        let rate = vectors_onto(rate, shift_s, frame.grid)?;
        let apart: Vec<Vector3<f64>> = measured.iter().zip(&rate).map(|(a, b)| a - b).collect();
        let mut residual = Vec::with_capacity(3 * frame.centers.len());
        frame.difference(&none, &apart, &mut residual);
        // a bias is no delay
        frame.remove_means(&mut residual);
        Some(residual)
    })
}

/// Removes the part of a residual that the columns explain.
fn partial_out(residual: &mut [f64], columns: &[Vec<f64>]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let normal = DMatrix::from_fn(columns.len(), columns.len(), |i, j| dot(&columns[i], &columns[j]));
    let Some(factor) = normal.cholesky() else { return };
    let theta = factor.solve(&DVector::from_fn(columns.len(), |i, _| dot(&columns[i], residual)));
    for (column, theta) in columns.iter().zip(theta.iter()) {
        residual.iter_mut().zip(column).for_each(|(residual, column)| *residual -= theta * column);
    }
}

/// Offset of a world velocity stream against the inertial unit, the attitude already in place.
#[must_use]
pub fn velocity_offset(
    velocity: &Stream,
    inertial: &InertialOnGrid<'_>,
    frame: &AlignFrame<'_>,
) -> Option<StreamOffset> {
    estimate(frame.centers.len(), |shift_s| {
        let velocity = vectors_onto(velocity, shift_s, frame.grid)?;
        let body: Vec<Vector3<f64>> =
            inertial.attitude.iter().zip(&velocity).map(|(q, v)| q.inverse_transform_vector(v)).collect();
        let rate_of_change: Vec<Vector3<f64>> = (0..body.len())
            .map(|i| {
                let up = inertial.attitude[i].inverse_transform_vector(&Vector3::z());
                inertial.specific_force[i] - inertial.rate[i].cross(&body[i]) - inertial.gravity_m_s2 * up
            })
            .collect();
        let mut residual = Vec::with_capacity(3 * frame.centers.len());
        frame.difference(&body, &rate_of_change, &mut residual);
        frame.remove_means(&mut residual);
        let column = |turned: Vec<Vector3<f64>>| {
            let mut column = Vec::with_capacity(residual.len());
            frame.difference(&vec![Vector3::zeros(); turned.len()], &turned, &mut column);
            frame.remove_means(&mut column);
            column
        };
        // what calls itself level may not be: gravity then pushes along the horizon, and that is no delay
        let mut columns: Vec<Vec<f64>> = [Vector3::x(), Vector3::y()]
            .map(|angle| {
                let across = angle.cross(&Vector3::z()) * inertial.gravity_m_s2;
                column(inertial.attitude.iter().map(|q| q.inverse_transform_vector(&across)).collect())
            })
            .into();
        if frame.askew {
            columns.extend([Vector3::x(), Vector3::y(), Vector3::z()].map(|angle| {
                column(inertial.specific_force.iter().map(|force| angle.cross(force)).collect())
            }));
        }
        partial_out(&mut residual, &columns);
        Some(residual)
    })
}

/// Offset of a position stream against the velocity on the grid.
#[must_use]
pub fn position_offset(
    position: &Stream,
    velocity: &[Vector3<f64>],
    frame: &AlignFrame<'_>,
) -> Option<StreamOffset> {
    estimate(frame.centers.len(), |shift_s| {
        let position = vectors_onto(position, shift_s, frame.grid)?;
        let mut residual = Vec::with_capacity(3 * frame.centers.len());
        frame.difference(&position, velocity, &mut residual);
        Some(residual)
    })
}

/// Grid and kernel of the comparison.
#[derive(Debug, Clone, Copy)]
pub struct AlignFrame<'a> {
    /// the inertial unit may be misaligned: its angles are estimated together with the offsets
    pub askew: bool,
    /// common time base
    pub grid: &'a Grid,
    /// weak form's kernel on it
    pub kernel: &'a WeakKernel,
    /// centres with good support
    pub centers: &'a [usize],
}

impl AlignFrame<'_> {
    /// Appends `integral phi (x' - rate)` for the three components at all centres.
    fn difference(&self, x: &[Vector3<f64>], rate: &[Vector3<f64>], out: &mut Vec<f64>) {
        for component in 0..3 {
            let x: Vec<f64> = x.iter().map(|v| v[component]).collect();
            let rate: Vec<f64> = rate.iter().map(|v| v[component]).collect();
            out.extend(self.centers.iter().map(|&c| self.kernel.at(1, &x, c) - self.kernel.at(0, &rate, c)));
        }
    }

    /// Subtracts the mean of each component, because an accelerometer's bias is not a delay.
    fn remove_means(&self, residual: &mut [f64]) {
        for component in residual.chunks_mut(self.centers.len().max(1)) {
            let mean = component.iter().sum::<f64>() / component.len() as f64;
            component.iter_mut().for_each(|value| *value -= mean);
        }
    }
}

/// The inertial unit's signals and the corrected attitude on the grid.
#[derive(Debug, Clone, Copy)]
pub struct InertialOnGrid<'a> {
    /// body to world
    pub attitude: &'a [UnitQuaternion<f64>],
    /// rad/s, body
    pub rate: &'a [Vector3<f64>],
    /// m/s^2, body
    pub specific_force: &'a [Vector3<f64>],
    /// m/s^2
    pub gravity_m_s2: f64,
}

/// Gauss-Newton over the shift; `residual(shift)` must have the same length each time.
fn estimate(instants: usize, residual: impl Fn(f64) -> Option<Vec<f64>>) -> Option<StreamOffset> {
    const STEP_S: f64 = 0.002;
    let mut shift = 0.0;
    let mut std_s = f64::INFINITY;
    for _ in 0..6 {
        let here = residual(shift)?;
        if instants < 20 || here.is_empty() {
            return None;
        }
        let (ahead, behind) = (residual(shift + STEP_S)?, residual(shift - STEP_S)?);
        let slope: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * STEP_S)).collect();
        let information: f64 = slope.iter().map(|s| s * s).sum();
        if information <= 0.0 {
            return None;
        }
        let update = -slope.iter().zip(&here).map(|(s, r)| s * r).sum::<f64>() / information;
        std_s = coloured_std((&slope, &here), instants, information);
        shift += update;
        if !shift.is_finite() || shift.abs() > LARGEST_S {
            return Some(StreamOffset { late_s: 0.0, std_s: f64::INFINITY, repaired: false });
        }
        if update.abs() < 1e-6 {
            break;
        }
    }
    let repaired = std_s < LEAST_PRECISE_S;
    Some(StreamOffset { late_s: shift, std_s, repaired })
}

/// Standard error of one coefficient with the scores' own autocovariance (Bartlett, 20 lags).
///
/// The components of one instant share their noise, so their scores are added before neighbours in time
/// are compared; `instants` is the length of one component's block.
fn coloured_std((slope, residual): (&[f64], &[f64]), instants: usize, information: f64) -> f64 {
    const LAGS: usize = 20;
    let mut score = vec![0.0; instants];
    for (slope, residual) in slope.chunks(instants).zip(residual.chunks(instants)) {
        for ((score, s), r) in score.iter_mut().zip(slope).zip(residual) {
            *score += s * r;
        }
    }
    let covariance = |lag: usize| -> f64 { score.iter().zip(&score[lag..]).map(|(a, b)| a * b).sum() };
    let mut variance = covariance(0);
    for lag in 1..=LAGS.min(score.len() - 1) {
        variance += 2.0 * (1.0 - lag as f64 / (LAGS as f64 + 1.0)) * covariance(lag);
    }
    variance.max(0.0).sqrt() / information
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rates of a vehicle that turns, each sample stamped late by this.
    fn rates(period_s: f64, late_s: f64) -> Stream {
        let time_s: Vec<f64> =
            (0..1500).map(|index| f64::from(index) * period_s).take_while(|t| *t < 30.0).collect();
        let at = |t: f64| [(3.0 * t).sin(), (2.1 * t + 0.4).cos(), 0.3 * (1.3 * t).sin()];
        let values = time_s.iter().flat_map(|t| at(t - late_s)).collect();
        Stream { time_s, width: 3, values }
    }

    #[test]
    fn rates_of_another_message_are_as_late_as_their_stamps() {
        let grid = Grid { start_s: 1.0, step_s: 0.02, count: 1400 };
        let kernel = WeakKernel::new(0.2, grid.step_s);
        let centers = kernel.centers(&vec![true; grid.count], 3);
        let frame = AlignFrame { askew: false, grid: &grid, kernel: &kernel, centers: &centers };
        for late_s in [-0.01, 0.0, 0.018] {
            let found = rate_offset(&rates(0.02, late_s), &rates(0.04, 0.0), &frame).unwrap();
            assert!(found.repaired && (found.late_s - late_s).abs() < 1e-4, "{late_s}: {found:?}");
        }
        // with a pause of the inertial unit nothing is known of it
        let mut paused = rates(0.04, 0.0);
        for time_s in paused.time_s.iter_mut().skip(400) {
            *time_s += 1.0;
        }
        assert_eq!(rate_offset(&rates(0.02, 0.0), &paused, &frame), None);
    }
}
