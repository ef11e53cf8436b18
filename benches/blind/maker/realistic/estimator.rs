//! An error-state Kalman filter of 15 states: position, velocity, attitude, biases of the rates and of the force.
//! What is measured late is held against what was believed when it is thought to have been true.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};

use super::super::GRAVITY;
use super::super::flight::TICK;
use super::position::{Fix, Reached, Trust};

const STATES: usize = 15;
const POSITION: usize = 0;
const VELOCITY: usize = 3;
const ATTITUDE: usize = 6;
const RATES: usize = 9;
const FORCE: usize = 12;

type Square = SMatrix<f64, STATES, STATES>;

/// Beliefs of a tick, for what comes late.
#[derive(Debug, Clone, Copy)]
struct Past {
    time: f64,
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    yaw: f64,
}

/// Ticks that are remembered.
const REMEMBERED: usize = 80;

/// The filter.
pub struct Estimator {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub rotation: Matrix3<f64>,
    /// rad/s and m/s^2
    pub bias_rates: Vector3<f64>,
    pub bias_force: Vector3<f64>,
    covariance: Square,
    past: VecDeque<Past>,
    trust: Trust,
    believed_late: f64,
    ticks: usize,
    /// sums of squared innovations over their variances, and their number: position, velocity, height, yaw
    pub innovations: [(f64, f64); 4],
}

impl Estimator {
    /// At rest at a place with first beliefs of the biases, which are wrong by about `doubt`.
    pub fn new(
        position: Vector3<f64>,
        (bias_rates, bias_force): (Vector3<f64>, Vector3<f64>),
        doubt: [f64; 2],
        (trust, believed_late): (Trust, f64),
    ) -> Self {
        let mut covariance = Square::zeros();
        for axis in 0..3 {
            covariance[(POSITION + axis, POSITION + axis)] = 0.25;
            covariance[(VELOCITY + axis, VELOCITY + axis)] = 0.01;
            covariance[(ATTITUDE + axis, ATTITUDE + axis)] = 4e-4;
            covariance[(RATES + axis, RATES + axis)] = doubt[0] * doubt[0];
            covariance[(FORCE + axis, FORCE + axis)] = doubt[1] * doubt[1];
        }
        Self {
            position,
            velocity: Vector3::zeros(),
            rotation: Matrix3::identity(),
            bias_rates,
            bias_force,
            covariance,
            past: VecDeque::with_capacity(REMEMBERED + 1),
            trust,
            believed_late,
            ticks: 0,
            innovations: [(0.0, 0.0); 4],
        }
    }

    /// One tick: the inertial sample that ends at `time`, and what has arrived.
    pub fn tick(&mut self, time: f64, (force, rates): (&Vector3<f64>, &Vector3<f64>), reached: &Reached) {
        self.predict(force, rates);
        let yaw = yaw_of(&self.rotation);
        self.past.push_back(Past { time, position: self.position, velocity: self.velocity, yaw });
        if self.past.len() > REMEMBERED {
            self.past.pop_front();
        }
        if let Some(fix) = &reached.fix {
            self.fix(fix);
        }
        if let Some(height) = reached.height {
            let off = height - self.position.z;
            self.correct(&along(POSITION + 2), (off, self.trust.height), 2);
        }
        if let Some(yaw) = reached.yaw {
            let off = wrapped(yaw - yaw_of(&self.rotation));
            self.correct(&self.yaw_slope(), (off, self.trust.yaw), 3);
        }
    }

    fn predict(&mut self, force: &Vector3<f64>, rates: &Vector3<f64>) {
        let (force, rates) = (force - self.bias_force, rates - self.bias_rates);
        let turn = Rotation3::new(rates * TICK);
        let middle = self.rotation * Rotation3::new(0.5 * TICK * rates).matrix();
        let gained = middle * force - Vector3::new(0.0, 0.0, GRAVITY);
        self.position += TICK * self.velocity + 0.5 * TICK * TICK * gained;
        self.velocity += TICK * gained;
        self.rotation *= turn.matrix();
        self.ticks += 1;
        if self.ticks.is_multiple_of(64) {
            let mut straight = Rotation3::from_matrix_unchecked(self.rotation);
            straight.renormalize();
            self.rotation = straight.into_inner();
        }
        let lean = -TICK * middle * force.cross_matrix();
        let back = turn.matrix().transpose();
        let half = shifted(&self.covariance, &lean, &(-TICK * middle), &back).transpose();
        self.covariance = shifted(&half, &lean, &(-TICK * middle), &back);
        let grown = [
            (VELOCITY, (self.trust.force * TICK).powi(2)),
            (ATTITUDE, (self.trust.rates * TICK).powi(2)),
            (RATES, 4e-8 * TICK),
            (FORCE, 1.6e-5 * TICK),
        ];
        for (place, variance) in grown {
            for axis in place..place + 3 {
                self.covariance[(axis, axis)] += variance;
            }
        }
    }

    fn fix(&mut self, fix: &Fix) {
        let taken = fix.arrives - self.believed_late;
        for axis in 0..3 {
            let Some(then) = self.then(taken) else { return };
            let off = fix.position[axis] - then.position[axis];
            let level = if axis == 2 && fix.velocity.is_some() { 1.5 } else { 1.0 };
            self.correct(&along(POSITION + axis), (off, level * self.trust.position), 0);
        }
        for axis in 0..3 {
            let (Some(velocity), Some(then)) = (fix.velocity, self.then(taken)) else { break };
            let off = velocity[axis] - then.velocity[axis];
            self.correct(&along(VELOCITY + axis), (off, self.trust.velocity), 1);
        }
        if let (Some(yaw), Some(then)) = (fix.yaw, self.then(taken)) {
            let off = wrapped(yaw - then.yaw);
            self.correct(&self.yaw_slope(), (off, self.trust.yaw), 3);
        }
    }

    /// What was believed at a time, as it is held now.
    fn then(&self, time: f64) -> Option<Past> {
        let later = self.past.iter().position(|past| past.time >= time).unwrap_or(self.past.len());
        let after = *self.past.get(later).or(self.past.back())?;
        let before = *self.past.get(later.saturating_sub(1))?;
        let apart = after.time - before.time;
        let share = if apart > 0.0 { ((time - before.time) / apart).clamp(0.0, 1.0) } else { 0.0 };
        Some(Past {
            time,
            position: before.position + share * (after.position - before.position),
            velocity: before.velocity + share * (after.velocity - before.velocity),
            yaw: before.yaw + share * wrapped(after.yaw - before.yaw),
        })
    }

    /// How yaw changes with the attitude's error.
    fn yaw_slope(&self) -> SVector<f64, STATES> {
        let r = &self.rotation;
        let (x, y) = (r[(0, 0)], r[(1, 0)]);
        let level = x * x + y * y;
        let mut slope = SVector::zeros();
        slope[ATTITUDE + 2] = (x * r[(1, 1)] - y * r[(0, 1)]) / level;
        slope[ATTITUDE + 1] = (y * r[(0, 2)] - x * r[(1, 2)]) / level;
        slope
    }

    /// A number that was measured: off by `off` from what was believed, good to `sigma`.
    fn correct(&mut self, slope: &SVector<f64, STATES>, (off, sigma): (f64, f64), kind: usize) {
        let cross = self.covariance * slope;
        let variance = slope.dot(&cross) + sigma * sigma;
        let gain = cross / variance;
        self.innovations[kind].0 += off * off / variance;
        self.innovations[kind].1 += 1.0;
        self.covariance -= gain * cross.transpose();
        let change = off * gain;
        let three = |place: usize| change.fixed_rows::<3>(place).into_owned();
        let yaw = yaw_of(&self.rotation);
        self.position += three(POSITION);
        self.velocity += three(VELOCITY);
        self.rotation *= Rotation3::new(three(ATTITUDE)).matrix();
        self.bias_rates += three(RATES);
        self.bias_force += three(FORCE);
        let yawed = wrapped(yaw_of(&self.rotation) - yaw);
        for past in &mut self.past {
            past.position += three(POSITION);
            past.velocity += three(VELOCITY);
            past.yaw += yawed;
        }
    }
}

/// Rows of the transition times a matrix.
fn shifted(matrix: &Square, lean: &Matrix3<f64>, push: &Matrix3<f64>, back: &Matrix3<f64>) -> Square {
    let rows = |place: usize| matrix.fixed_rows::<3>(place).into_owned();
    let (velocity, attitude) = (rows(VELOCITY), rows(ATTITUDE));
    let mut next = *matrix;
    next.fixed_rows_mut::<3>(POSITION).copy_from(&(rows(POSITION) + TICK * velocity));
    next.fixed_rows_mut::<3>(VELOCITY).copy_from(&(velocity + lean * attitude + push * rows(FORCE)));
    next.fixed_rows_mut::<3>(ATTITUDE).copy_from(&(back * attitude - TICK * rows(RATES)));
    next
}

fn along(place: usize) -> SVector<f64, STATES> {
    let mut slope = SVector::zeros();
    slope[place] = 1.0;
    slope
}

fn yaw_of(rotation: &Matrix3<f64>) -> f64 {
    rotation[(1, 0)].atan2(rotation[(0, 0)])
}

fn wrapped(angle: f64) -> f64 {
    (angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI
}
